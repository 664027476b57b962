with Ada.Text_IO;           use Ada.Text_IO;
with Ada.Exceptions;
with Ada.Strings.Unbounded; use Ada.Strings.Unbounded;
with Alarms;                use Alarms;
with Bus;
with Catalogue;             use Catalogue;
with Clocks;                use Clocks;
with Conditions;
with Craft;                 use Craft;
with Gateway;
with Guards;
with Plans;                 use Plans;
with Slots;
with Step_Log;
with Undecided;
with Ways;

package body Machine is

   --  Seconds for which the vehicle comes up, after a fault, and in which the last goal is still said.
   Coming_Up : constant Long_Float := 600.0;
   Farewell  : constant Duration := 0.5;

   --  Number of the move that the robot is at.
   Current : Positive := 1;

   Nothing : constant String := """""";

   procedure Stay (Plan : Plans.Plan; Seconds : Long_Float);
   procedure Use_Device (Plan : Plans.Plan; Does : Action);
   procedure Act (Plan : Plans.Plan; At_Move : Move; Actions : Action_Lists.Vector);
   procedure Follow (Plan : Plans.Plan; Along : Move);
   procedure Pause_Within (Plan : Plans.Plan; Along : Move; Since : Long_Float);
   procedure Wait (Plan : Plans.Plan; Along : Move; Since : Long_Float);
   function Is_Chosen (Plan : Plans.Plan; Along : Move; Since : Long_Float) return Boolean;
   procedure Move_On (Plan : Plans.Plan; Along : Move; To : out Natural);
   procedure Enter (Plan : Plans.Plan; From : in out Natural; To : Natural);
   procedure Carry_Out (Plan : Plans.Plan);
   procedure Surface;

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
            Ways.Go (Plan, Along);

         when Holds =>
            Stay (Plan, Along.Seconds);

         when Turns =>
            Ways.Turn (Plan, Along);

         when Stops =>
            Vehicle.Begin_Goal
              ((Mode => (if Plan.Floats then MODE_IDLE else MODE_SURFACE), others => <>));
      end case;
   end Follow;

   --  Pause, unless what is waited for since then takes too long.
   procedure Pause_Within (Plan : Plans.Plan; Along : Move; Since : Long_Float) is
   begin
      if Now - Since >= Along.Longest then
         Fail (WAIT_TOO_LONG'Image, "what is waited for does not come");
      end if;
      Pause (Plan);
   end Pause_Within;

   --  Wait until all slots are active that a move waits for.
   procedure Wait (Plan : Plans.Plan; Along : Move; Since : Long_Float) is
      Alone_Since : Long_Float := Endless;
   begin
      loop
         exit when Slots.Pass (Along);
         if Slots.Is_Hopeless (Along) then
            Alone_Since := Long_Float'Min (Alone_Since, Now);
            if Now - Alone_Since >= Along.Alone then
               Fail (PEER_LOST'Image, "nobody is left who could set what is waited for");
            end if;
         else
            Alone_Since := Endless;
         end if;
         Pause_Within (Plan, Along, Since);
      end loop;
   end Wait;

   --  Return whether a condition holds, once that is known.
   function Is_Chosen (Plan : Plans.Plan; Along : Move; Since : Long_Float) return Boolean is
   begin
      loop
         begin
            return Conditions.Holds (To_String (Along.Condition), Vehicle.Told);
         exception
            when Undecided.Not_Known =>
               Pause_Within (Plan, Along, Since);
         end;
      end loop;
   end Is_Chosen;

   procedure Move_On (Plan : Plans.Plan; Along : Move; To : out Natural) is
      Id    : constant String := To_String (Along.Id);
      Since : constant Long_Float := Now;
   begin
      Wait (Plan, Along, Since);
      case Along.Way is
         when Ends =>
            To := 0;

         when Takes =>
            To := Along.To;
            Step_Log.Write ("take", Id, To_String (Plan.Moves (To).Id), Nothing);

         when Chooses =>
            if Is_Chosen (Plan, Along, Since) then
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
