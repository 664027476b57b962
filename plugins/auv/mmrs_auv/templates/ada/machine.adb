with Ada.Numerics.Long_Elementary_Functions; use Ada.Numerics.Long_Elementary_Functions;
with Ada.Text_IO;                            use Ada.Text_IO;
with Ada.Exceptions;
with Ada.Strings.Unbounded;                  use Ada.Strings.Unbounded;
with Ada.Numerics;
with Bus;
with Catalogue;                              use Catalogue;
with Clocks;                                 use Clocks;
with Conditions;
with Craft;                                  use Craft;
with Gateway;
with Guards;
with Plans;                                  use Plans;
with Slots;
with Step_Log;
with Undecided;

package body Machine is

   Failed : exception;

   --  Seconds of silence of the whole bus, and of the sensor controller, that count as loss.
   Silent : constant Long_Float := 2.0;
   Stale  : constant Long_Float := 1.0;

   --  Metres of uncertainty of one sigma above which the place counts as lost.
   Lost : constant Long_Float := 10.0;

   --  Seconds for which the vehicle may not know where it is, at first; for which it comes up, after a fault;
   --  and in which the last goal is still said.
   Getting_Ready : constant Long_Float := 60.0;
   Coming_Up     : constant Long_Float := 600.0;
   Farewell      : constant Duration := 0.5;

   --  Number of the move that the robot is at.
   Current : Positive := 1;

   Nothing : constant String := """""";

   procedure Fail (Event, Why : String);
   procedure Look (Plan : Plans.Plan);
   function Is_Ready return Boolean;
   procedure Get_Ready;
   procedure Pause (Plan : Plans.Plan);
   function Facing (Of_Move : Move; From : Place) return Long_Float;
   procedure Go (Plan : Plans.Plan; To : Goal);
   procedure Travel (Plan : Plans.Plan; Along : Move);
   procedure Stay (Plan : Plans.Plan; Seconds : Long_Float);
   procedure Use_Device (Plan : Plans.Plan; Does : Action);
   procedure Act (Plan : Plans.Plan; At_Move : Move; Actions : Action_Lists.Vector);
   procedure Follow (Plan : Plans.Plan; Along : Move);
   procedure Move_On (Plan : Plans.Plan; Along : Move; To : out Natural);
   procedure Enter (Plan : Plans.Plan; From : in out Natural; To : Natural);
   procedure Carry_Out (Plan : Plans.Plan);
   procedure Surface;

   procedure Fail (Event, Why : String) is
   begin
      Put_Line (Standard_Error, Event & ": " & Why);
      raise Failed with Event;
   end Fail;

   --  Raise Failed where something has gone wrong with the vehicle.
   procedure Look (Plan : Plans.Plan) is
      Known : constant State := Vehicle.Told;
   begin
      Guards.Kick;
      if Known.Emergency /= 0 then
         Fail ("CRASHED", "the dive was given up, reason" & Known.Emergency'Image);
      elsif Bus.Is_Gone or else Now - Known.Heard_At > Silent then
         Fail ("LINK_LOST", "nothing is heard on the bus");
      elsif not Known.Trusted or else Now - Known.Known_At > Silent then
         Fail ("POSITION_LOST", "depth and heading are not known");
      elsif Known.Uncertainty > Lost then
         Fail ("POSITION_LOST", "the place is not known");
      elsif Known.Charge >= 0.0 and then Known.Charge < Plan.Reserve then
         Fail ("BATTERY_LOW", "the battery has no more than the reserve");
      end if;
   end Look;

   function Is_Ready return Boolean is
      Known : constant State := Vehicle.Told;
   begin
      return Known.Trusted and then Now - Known.Known_At < Stale and then Known.Uncertainty <= Lost;
   end Is_Ready;

   procedure Get_Ready is
      Until_Then : constant Long_Float := Now + Getting_Ready;
   begin
      while not Is_Ready loop
         Guards.Kick;
         if Bus.Is_Gone or else Now > Until_Then then
            if Bus.Is_Gone or else Now - Vehicle.Told.Heard_At > Silent then
               Fail ("LINK_LOST", "no vehicle is heard on its bus");
            end if;
            Fail ("POSITION_LOST", "the vehicle does not know where it is");
         end if;
         delay 0.05;
      end loop;
   end Get_Ready;

   procedure Pause (Plan : Plans.Plan) is
   begin
      Look (Plan);
      Gateway.Live;
      delay 0.05;
   end Pause;

   function Facing (Of_Move : Move; From : Place) return Long_Float is
      North : constant Long_Float := Of_Move.Seen.North - From.North;
      East  : constant Long_Float := Of_Move.Seen.East - From.East;
   begin
      return Arctan (East, North) * 180.0 / Ada.Numerics.Pi - Of_Move.Angle;
   end Facing;

   --  Begin a goal, and wait until it is reached.
   procedure Go (Plan : Plans.Plan; To : Goal) is
   begin
      Vehicle.Begin_Goal (To);
      loop
         Pause (Plan);
         exit when Vehicle.Told.Progress = PROGRESS_REACHED;
         if Vehicle.Told.Progress = PROGRESS_FAILED then
            Fail ("NO_PROGRESS", "does not get nearer");
         end if;
      end loop;
   end Go;

   procedure Travel (Plan : Plans.Plan; Along : Move) is
      Here  : constant Place := Vehicle.Told.Here;
      There : Place := Along.Target;
      Way   : constant Long_Float :=
        Sqrt ((There.North - Here.North) ** 2 + (There.East - Here.East) ** 2 + (There.Depth - Here.Depth) ** 2);
      Part  : Long_Float;
      To    : Goal;
   begin
      if Along.Away > 0.0 then
         Part := (if Way <= Along.Away then 0.0 else (Way - Along.Away) / Way);
         There := (North => Here.North + Part * (There.North - Here.North),
                   East  => Here.East + Part * (There.East - Here.East),
                   Depth => Here.Depth + Part * (There.Depth - Here.Depth));
      end if;
      There.Depth := Long_Float'Max (0.0, There.Depth);
      To := (Mode => MODE_GO_TO, Where => There, Speed => Along.Speed, Along => True, others => <>);
      if Along.Looks
        and then (abs (Along.Seen.North - There.North) > 1.0E-6 or else abs (Along.Seen.East - There.East) > 1.0E-6)
      then
         To.Along := False;
         To.Heading := Facing (Along, There);
      end if;
      Go (Plan, To);
   end Travel;

   procedure Stay (Plan : Plans.Plan; Seconds : Long_Float) is
      Until_Then : constant Long_Float := Now + Seconds;
   begin
      while Now < Until_Then loop
         Pause (Plan);
      end loop;
   end Stay;

   procedure Use_Device (Plan : Plans.Plan; Does : Action) is
      Until_Then : constant Long_Float := Now + Does.Patience;
   begin
      Vehicle.Operate (Does.Number, Does.Does, Does.Parameter);
      loop
         Pause (Plan);
         exit when Vehicle.Told.Answer = PROGRESS_REACHED;
         if Vehicle.Told.Answer = PROGRESS_FAILED or else Now >= Until_Then then
            Fail ("DEVICE_SILENT", "device" & Does.Number'Image & " does not do it");
         end if;
      end loop;
   end Use_Device;

   procedure Act (Plan : Plans.Plan; At_Move : Move; Actions : Action_Lists.Vector) is
      Id : constant String := To_String (At_Move.Id);

      procedure Wait;

      procedure Wait is
      begin
         Pause (Plan);
      end Wait;
   begin
      for Each of Actions loop
         Look (Plan);
         case Each.Kind is
            when Feedback =>
               Put_Line (To_String (Each.Words));
               Step_Log.Write ("act", Id, To_String (Each.Detail), Nothing);

            when Device =>
               Use_Device (Plan, Each);
               Step_Log.Write ("act", Id, To_String (Each.Detail), Nothing);

            when Notify =>
               Slots.Tell (Each, Id, Wait'Access);
         end case;
      end loop;
   end Act;

   procedure Follow (Plan : Plans.Plan; Along : Move) is
   begin
      case Along.Kind is
         when Starts =>
            null;

         when Goes =>
            Travel (Plan, Along);

         when Holds =>
            Stay (Plan, Along.Seconds);

         when Turns =>
            Go (Plan,
                (Mode => MODE_TURN, Heading => Facing (Along, Vehicle.Told.Here), others => <>));

         when Stops =>
            Vehicle.Begin_Goal
              ((Mode => (if Plan.Floats then MODE_IDLE else MODE_SURFACE), others => <>));
      end case;
   end Follow;

   procedure Move_On (Plan : Plans.Plan; Along : Move; To : out Natural) is
      Id : constant String := To_String (Along.Id);
   begin
      loop
         exit when Slots.Pass (Along);
         if Slots.Is_Hopeless (Along) then
            Fail ("PEER_LOST", "nobody is left who could set what is waited for");
         end if;
         Pause (Plan);
      end loop;
      case Along.Way is
         when Ends =>
            To := 0;

         when Takes =>
            To := Along.To;
            Step_Log.Write ("take", Id, To_String (Plan.Moves (To).Id), Nothing);

         when Chooses =>
            if Conditions.Holds (To_String (Along.Condition), Vehicle.Told) then
               To := Along.To;
               Step_Log.Write ("choose", Id, """true""", Nothing);
            else
               To := Along.Otherwise;
               Step_Log.Write ("choose", Id, """false""", Nothing);
            end if;
      end case;
   end Move_On;

   --  Leave and enter composed states.
   procedure Enter (Plan : Plans.Plan; From : in out Natural; To : Natural) is
   begin
      if From /= To and then From /= 0 then
         Put_Line ("leaves " & To_String (Plan.Tasks (From)));
      end if;
      if From /= To and then To /= 0 then
         Put_Line ("enters " & To_String (Plan.Tasks (To)));
      end if;
      From := To;
   end Enter;

   procedure Carry_Out (Plan : Plans.Plan) is
      Inside : Natural := 0;
      Next   : Natural;
   begin
      Get_Ready;
      loop
         declare
            Along : Move renames Plan.Moves (Current).Element.all;
            Id    : constant String := To_String (Along.Id);
         begin
            Enter (Plan, Inside, Along.Task_Number);
            Put_Line ("begins " & To_String (Along.Name));
            Act (Plan, Along, Along.Before);
            Step_Log.Write ("begin", Id, Nothing, Nothing);
            Follow (Plan, Along);
            Step_Log.Write ("end", Id, Nothing, Nothing);
            Act (Plan, Along, Along.After);
            Move_On (Plan, Along, Next);
         end;
         exit when Next = 0;
         Current := Next;
      end loop;
      Enter (Plan, Inside, 0);
   end Carry_Out;

   --  Come up, by thrust unless the dive was given up, as long as the bus is there.
   procedure Surface is
      Until_Then : constant Long_Float := Now + Coming_Up;
   begin
      Vehicle.Begin_Goal ((Mode => MODE_SURFACE, others => <>));
      loop
         Guards.Kick;
         exit when Bus.Is_Gone or else Now > Until_Then;
         exit when Vehicle.Told.Progress = PROGRESS_REACHED;
         exit when Now - Vehicle.Told.Known_At < Stale and then Vehicle.Told.Here.Depth < 0.5;
         delay 0.05;
      end loop;
   end Surface;

   function Runs (Plan : Plans.Plan) return Boolean is
      procedure Give_Up (Event : String);

      procedure Give_Up (Event : String) is
      begin
         Step_Log.Write ("fault", To_String (Plan.Moves (Current).Id), """" & Event & """", Nothing);
         Surface;
      end Give_Up;
   begin
      Current := Plan.Start;
      Carry_Out (Plan);
      Gateway.Leave;
      delay Farewell;
      return True;
   exception
      when Error : Failed =>
         Give_Up (Ada.Exceptions.Exception_Message (Error));
         return False;
      when Error : Gateway.Refused =>
         Put_Line (Standard_Error, Ada.Exceptions.Exception_Message (Error));
         Give_Up ("PEER_LOST");
         return False;
      when Error : Undecided.Not_Decided =>
         Put_Line (Standard_Error, Ada.Exceptions.Exception_Message (Error));
         Give_Up ("CONDITION");
         return False;
      when Error : others =>
         Put_Line (Standard_Error, Ada.Exceptions.Exception_Information (Error));
         Give_Up ("CRASHED");
         return False;
   end Runs;

end Machine;
