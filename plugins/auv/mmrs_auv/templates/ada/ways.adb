with Ada.Numerics;
with Ada.Numerics.Long_Elementary_Functions; use Ada.Numerics.Long_Elementary_Functions;
with Ada.Strings.Unbounded;                  use Ada.Strings.Unbounded;
with Alarms;                                 use Alarms;
with Catalogue;                              use Catalogue;
with Clocks;                                 use Clocks;
with Craft;                                  use Craft;
with Plans;                                  use Plans;
with Sight;
with Sightings;
with Tables;                                 use Tables;
with Tracks;

package body Ways is

   function Facing (Seen : Place; Angle : Long_Float; From : Place) return Long_Float;
   function Are_Apart (Left, Right : Place) return Boolean;
   function Is_Reached return Boolean;
   procedure Finish_Goal (Plan : Plans.Plan);
   function Goal_Of (Along : Move; From, To : Place; Found : Boolean) return Goal;
   procedure Search (Along : Boolean);
   procedure Seek (Plan : Plans.Plan; Along : Move; Ends_At : out Place);
   function Is_Far (Where : Place; Along : Move) return Boolean;

   function Facing (Seen : Place; Angle : Long_Float; From : Place) return Long_Float is
     (Arctan (Seen.East - From.East, Seen.North - From.North) * (180.0 / Ada.Numerics.Pi) - Angle);

   function Are_Apart (Left, Right : Place) return Boolean is
     (abs (Left.North - Right.North) > 1.0E-6 or else abs (Left.East - Right.East) > 1.0E-6);

   --  Whether the goal in force is reached. Raises Failed where it cannot be.
   function Is_Reached return Boolean is
      Now_At : constant Natural := Vehicle.Told.Progress;
   begin
      if Now_At = PROGRESS_FAILED then
         Fail (NO_PROGRESS, "does not get nearer");
      end if;
      return Now_At = PROGRESS_REACHED;
   end Is_Reached;

   procedure Finish_Goal (Plan : Plans.Plan) is
   begin
      loop
         Pause (Plan);
         exit when Is_Reached;
      end loop;
   end Finish_Goal;

   --  The goal by which a move from a place leads to another, at which its object was found or not.
   function Goal_Of (Along : Move; From, To : Place; Found : Boolean) return Goal is
      Seen   : constant Place := (if Found and Along.Looks_At_It then To else Along.Seen);
      There  : Place := Short_Of (From, To, Along.Away);
      Wanted : Goal;
   begin
      There.Depth := Long_Float'Max (0.0, There.Depth);
      Wanted := (Mode => MODE_GO_TO, Where => There, Speed => Along.Speed, Along => True, others => <>);
      if Along.Looks and then Are_Apart (Seen, There) then
         Wanted.Along := False;
         Wanted.Heading := Facing (Seen, Along.Angle, There);
      end if;
      return Wanted;
   end Goal_Of;

   --  Look around on the spot, or along a spiral.
   procedure Search (Along : Boolean) is
      Known : constant State := Vehicle.Told;
      Here  : Place := Known.Here;
   begin
      Here.Depth := Long_Float'Max (0.0, Here.Depth);
      Vehicle.Begin_Goal
        ((Mode    => MODE_SEARCH,
          Where   => Here,
          Heading => (if Along then 0.0 else Known.Heading),
          Along   => Along,
          others  => <>));
   end Search;

   --  Whether what is seen there is another object, since it is too far from where the move's is expected.
   function Is_Far (Where : Place; Along : Move) return Boolean is
     (Along.Tolerance >= 0.0 and then Away (Where, Along.Target) > Along.Tolerance);

   --  Go to an object, wherever it is seen near where it is expected, or where others have seen it.
   procedure Seek (Plan : Plans.Plan; Along : Move; Ends_At : out Place) is
      Here     : constant Place := Vehicle.Told.Here;
      Name     : constant String := To_String (Along.Object);
      Searches : Natural := 0;
      Found    : Boolean := False;
      Where    : Place;
   begin
      Sightings.Told_Of (Plan, Name, Found, Where);
      if Found then
         Where.Depth := Along.Target.Depth;
         if Is_Far (Where, Along) then
            Fail (OBJECT_NOT_FOUND, "others have seen it where it is not expected");
         end if;
      else
         Where := Along.Target;
      end if;
      Vehicle.Begin_Goal (Goal_Of (Along, Here, Where, Found => False));
      loop
         Pause (Plan);
         Sight.Look_For (Name, Now, Found, Where);
         exit when Found and then not Is_Far (Where, Along);
         if (if Searches = 0 then Is_Reached else Vehicle.Told.Progress in PROGRESS_REACHED | PROGRESS_FAILED) then
            if Searches = 2 then
               Fail (OBJECT_NOT_FOUND, "it is not seen where it is expected");
            end if;
            Searches := Searches + 1;
            Search (Along => Searches = 2);
         end if;
      end loop;
      Vehicle.Begin_Goal (Goal_Of (Along, Here, Where, Found => True));
      Ends_At := Vehicle.Wanted.Where;
      Finish_Goal (Plan);
   end Seek;

   procedure Go (Plan : Plans.Plan; Number : Positive) is
      Along   : Move renames Plan.Moves (Number).Element.all;
      Here    : constant Place := Vehicle.Told.Here;
      Ends_At : Place;
   begin
      if Tracks.Is_Empty then
         Tracks.Pass (Number, Here);
      end if;
      if Along.Object /= "" and then Sight.Is_Open then
         Seek (Plan, Along, Ends_At);
      else
         Vehicle.Begin_Goal (Goal_Of (Along, Here, Along.Target, Found => False));
         Ends_At := Vehicle.Wanted.Where;
         Finish_Goal (Plan);
      end if;
      Tracks.Pass (Number, Ends_At);
   end Go;

   procedure Turn (Plan : Plans.Plan; To : Move) is
      Here : constant Place := Vehicle.Told.Here;
   begin
      if Are_Apart (To.Seen, Here) then
         Vehicle.Begin_Goal ((Mode => MODE_TURN, Heading => Facing (To.Seen, To.Angle, Here), others => <>));
         Finish_Goal (Plan);
      end if;
   end Turn;

   procedure Hold is
      Known : constant State := Vehicle.Told;
      Here  : Place := Known.Here;
   begin
      Here.Depth := Long_Float'Max (0.0, Here.Depth);
      Vehicle.Begin_Goal ((Mode => MODE_HOLD, Where => Here, Heading => Known.Heading, others => <>));
   end Hold;

   procedure Back_Out (Plan : Plans.Plan) is
   begin
      for Each of Tracks.Way_Back (Plan, Vehicle.Told.Here) loop
         Vehicle.Begin_Goal
           ((Mode => MODE_GO_TO, Where => Each, Speed => Plan.Cruise, Along => True, others => <>));
         Finish_Goal (Plan);
      end loop;
   end Back_Out;

end Ways;
