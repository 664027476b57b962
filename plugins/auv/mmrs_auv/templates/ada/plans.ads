--  A robot's behaviour as data: moves, what is done before and after them, what follows.
with Ada.Containers.Vectors;
with Ada.Strings.Unbounded; use Ada.Strings.Unbounded;
with Tables;                use Tables;

package Plans is

   subtype Text is Unbounded_String;

   function "+" (Item : String) return Text renames To_Unbounded_String;

   type Place is record
      North, East, Depth : Long_Float := 0.0;
   end record;

   function Away (From, To : Place) return Long_Float;

   --  The place on the straight way so many metres before its end; From where that is nearer.
   function Short_Of (From, To : Place; Metres : Long_Float) return Place;

   package Numbers is new Ada.Containers.Vectors (Positive, Positive);

   None : constant Numbers.Vector := Numbers.Empty_Vector;

   function "&" (Left : Numbers.Vector; Right : Positive) return Numbers.Vector renames Numbers."&";

   type Action_Kind is (Feedback, Device, Notify);

   --  Detail and Slots as logs have them, in JSON; Words for people. Sets: numbers of own slots;
   --  Told: the same and those of other robots as the gateway reads them.
   type Action (Kind : Action_Kind := Feedback) is record
      Detail : Text;
      case Kind is
         when Feedback =>
            Words : Text;

         when Device =>
            Number, Does        : Natural;
            Parameter, Patience : Long_Float;

         when Notify =>
            Slots, Told : Text;
            Sets        : Numbers.Vector;
            Active      : Boolean;
      end case;
   end record;

   package Action_Lists is new Ada.Containers.Vectors (Positive, Action);

   type Move_Kind is (Starts, Goes, Holds, Charges, Turns, Stops);

   type Way_Kind is (Ends, Takes, Chooses);

   type Seconds_Of is array (Lasting) of Long_Float;

   Endless : constant Long_Float := Long_Float'Last;

   --  Id in JSON, Name for people. Task_Number: the composed state that the move belongs to; 0: none.
   --  Awaited, Senders: own slots, and other robots that set them, lists in JSON.
   --  Target, Away and Speed of Goes: it ends so many metres before the target. Looks: at Seen, turned by
   --  Angle degrees. Object: what the target is, its name in JSON, which is no farther than Tolerance from there
   --  (negative: it may be anywhere); Looks_At_It: it is what is looked at too. Waits: own slots that must be
   --  active; Is_Special: the wait has Bears and an Answer of its own.
   --  Otherwise: where a choice leads that does not hold.
   type Move is record
      Kind          : Move_Kind := Starts;
      Id, Name      : Text;
      Task_Number   : Natural := 0;
      Target, Seen  : Place;
      Away, Speed   : Long_Float := 0.0;
      Looks         : Boolean := False;
      Angle         : Long_Float := 0.0;
      Object        : Text;
      Tolerance     : Long_Float := -1.0;
      Looks_At_It   : Boolean := False;
      Seconds       : Long_Float := 0.0;
      Before, After : Action_Lists.Vector;
      Way           : Way_Kind := Ends;
      To, Otherwise : Natural := 0;
      Condition     : Text;
      Waits         : Numbers.Vector;
      Awaited       : Text;
      Senders       : Text;
      Is_Special    : Boolean := False;
      Bears         : Seconds_Of := (others => Endless);
      Answer        : Response_To := Undeclared;
   end record;

   package Move_Lists is new Ada.Containers.Vectors (Positive, Move);
   package Text_Lists is new Ada.Containers.Vectors (Positive, Text);

   --  Robot, Robots (all of the mission) and Slots in JSON; Eyes: how its cameras name it, in JSON; Log: the name
   --  of its file. Step: metres of depth in a step of goals on the bus; 0: not known. Reserve: part of the battery
   --  that must remain. Cruise: metres per second on the way back. Surface: height of the water above the mission's
   --  origin. Afloat: depth above which the vehicle is at the surface, metres; 0: not known. Alone: no other robot is waited for. Bears: seconds that an event lasts before it is answered; Answer:
   --  how.
   type Plan is record
      Robot, Robots : Text;
      Eyes          : Text;
      Name, Log     : Text;
      Step, Reserve : Long_Float := 0.0;
      Cruise        : Long_Float := 0.0;
      Surface       : Long_Float := 0.0;
      Afloat        : Long_Float := 0.0;
      Floats, Alone : Boolean := True;
      Bears         : Seconds_Of := (others => Endless);
      Answer        : Response_To := Undeclared;
      Start         : Positive := 1;
      Slots, Tasks  : Text_Lists.Vector;
      Moves         : Move_Lists.Vector;
   end record;

end Plans;
