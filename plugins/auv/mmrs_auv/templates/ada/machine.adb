with Ada.Text_IO;           use Ada.Text_IO;
with Ada.Exceptions;        use Ada.Exceptions;
with Ada.Strings.Unbounded; use Ada.Strings.Unbounded;
with Alarms;                use Alarms;
with Catalogue;             use Catalogue;
with Clocks;                use Clocks;
with Conditions;
with Craft;                 use Craft;
with Gateway;
with Plans;                 use Plans;
with Responses;
with Slots;
with Step_Log;
with Tables;                use Tables;
with Tracks;
with Undecided;
with Ways;
with Wire;

package body Machine is

   --  Number of the move that the robot is at, and how faults are answered there.
   Current : Positive := 1;
   Answer  : Response_To := Undeclared;

   Nothing : constant String := """""";

   procedure Keep_Place;
   procedure Stay_Put;
   procedure Stay (Plan : Plans.Plan; Seconds : Long_Float);
   procedure Use_Device (Plan : Plans.Plan; Does : Action);
   procedure Act (Plan : Plans.Plan; At_Move : Move; Actions : Action_Lists.Vector);
   procedure Follow (Plan : Plans.Plan; Along : Move);
   procedure Charge (Plan : Plans.Plan; Seconds : Long_Float);
   procedure Heed (Plan : Plans.Plan; Along : Move);
   procedure Fail_Unless_Borne (What : Event; Why : String);
   procedure Pause_Within (Plan : Plans.Plan; Since : Long_Float);
   procedure Wait (Plan : Plans.Plan; Along : Move; Since : Long_Float);
   function Is_Chosen (Plan : Plans.Plan; Along : Move; Since : Long_Float) return Boolean;
   procedure Move_On (Plan : Plans.Plan; Along : Move; To : out Natural);
   procedure Enter (Plan : Plans.Plan; From : in out Natural; To : Natural);
   procedure Carry_Out (Plan : Plans.Plan);
   procedure End_Early (Plan : Plans.Plan; What : Event);

   --  Hold where the vehicle is unless it was given a goal before, which is in force then.
   procedure Keep_Place is
      Known : constant Craft.State := Vehicle.Told;
      Here  : Place := Known.Here;
   begin
      if Vehicle.Wanted.Mode = MODE_IDLE and then Vehicle.Wanted.Number = 0 then
         Here.Depth := Long_Float'Max (0.0, Here.Depth);
         Vehicle.Begin_Goal ((Mode => MODE_HOLD, Where => Here, Heading => Known.Heading, others => <>));
      end if;
   end Keep_Place;

   --  Hold where the vehicle is, unless a goal is in force.
   procedure Stay_Put is
   begin
      if Vehicle.Wanted.Mode = MODE_IDLE then
         Ways.Hold;
      end if;
   end Stay_Put;

   procedure Stay (Plan : Plans.Plan; Seconds : Long_Float) is
      Until_Then : constant Long_Float := Now + Seconds;
   begin
      if Seconds > 0.0 then
         Stay_Put;
      end if;
      if Seconds > 0.0 then
         Keep_Place;
      end if;
      while Now < Until_Then loop
         Pause (Plan);
      end loop;
   end Stay;

   --  Stay at the surface until the battery is full.
   procedure Charge (Plan : Plans.Plan; Seconds : Long_Float) is
      Since : constant Long_Float := Now;
      Left  : Long_Float;
   begin
      Tracks.Forget;
      Vehicle.Begin_Goal ((Mode => MODE_SURFACE, others => <>));
      loop
         Pause (Plan);
         Left := Vehicle.Told.Charge;
         exit when Now - Since >= Seconds and then (Left < 0.0 or else Left >= LIMIT_FULL);
         if Now - Since >= LIMIT_CHARGING * Seconds + LIMIT_CHARGING_SPARE then
            Fail_Unless_Borne (BATTERY_LOW, "charging has not filled the battery");
            exit;
         end if;
      end loop;
   end Charge;

   procedure Fail_Unless_Borne (What : Event; Why : String) is
   begin
      if Answer (What) /= Goes_On then
         Fail (What, Why);
      end if;
      Put_Line (Standard_Error, What'Image & ": " & Why & "; it goes on");
   end Fail_Unless_Borne;

   procedure Use_Device (Plan : Plans.Plan; Does : Action) is
      Until_Then : constant Long_Float := Now + Does.Patience;
   begin
      Vehicle.Operate (Does.Number, Does.Does, Does.Parameter);
      loop
         Pause (Plan);
         exit when Vehicle.Told.Answer = PROGRESS_REACHED;
         if Vehicle.Told.Answer = PROGRESS_FAILED or else Now >= Until_Then then
            Fail_Unless_Borne (DEVICE_SILENT, "device" & Does.Number'Image & " does not do it");
            exit;
         end if;
      end loop;
   end Use_Device;

   procedure Act (Plan : Plans.Plan; At_Move : Move; Actions : Action_Lists.Vector) is
      Id    : constant String := To_String (At_Move.Id);
      Since : Long_Float;

      procedure Wait;

      procedure Wait is
      begin
         if Now - Since >= Patience (PEER_LOST) then
            Fail (PEER_LOST, "not all robots answer whose slots are to be set");
         end if;
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
               Since := Now;
               Slots.Tell (Plan, Each, Id, Wait'Access);
         end case;
      end loop;
   end Act;

   procedure Follow (Plan : Plans.Plan; Along : Move) is
   begin
      case Along.Kind is
         when Starts =>
            null;

         when Goes =>
            Ways.Go (Plan, Current);

         when Holds =>
            Stay (Plan, Along.Seconds);

         when Charges =>
            Charge (Plan, Along.Seconds);

         when Turns =>
            Ways.Turn (Plan, Along);

         when Stops =>
            Vehicle.Begin_Goal
              ((Mode => (if Plan.Floats then MODE_IDLE else MODE_SURFACE), others => <>));
      end case;
   end Follow;

   --  Answer faults as the wait of a move says, or else as the whole plan does.
   procedure Heed (Plan : Plans.Plan; Along : Move) is
   begin
      Answer := (if Along.Is_Special then Along.Answer else Plan.Answer);
      Alarms.Heed (if Along.Is_Special then Along.Bears else Plan.Bears);
   end Heed;

   --  Pause, unless what is waited for since then takes too long.
   procedure Pause_Within (Plan : Plans.Plan; Since : Long_Float) is
   begin
      if Now - Since >= Patience (WAIT_TOO_LONG) then
         Fail (WAIT_TOO_LONG, "what is waited for does not come");
      end if;
      Pause (Plan);
   end Pause_Within;

   --  Wait until all slots are active that a move waits for.
   procedure Wait (Plan : Plans.Plan; Along : Move; Since : Long_Float) is
      Alone_Since : Long_Float := Endless;
   begin
      loop
         exit when Slots.Pass (Along);
         Stay_Put;
         if Slots.Is_Hopeless (Along) then
            Alone_Since := Long_Float'Min (Alone_Since, Now);
            if Now - Alone_Since >= Patience (PEER_LOST) then
               Fail (PEER_LOST, "nobody is left who could set what is waited for");
            end if;
         else
            Alone_Since := Endless;
         end if;
         Keep_Place;
         Pause_Within (Plan, Since);
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
               Pause_Within (Plan, Since);
            when Error : others =>
               Fail (CONDITION_FAILED, Exception_Message (Error));
         end;
      end loop;
   end Is_Chosen;

   procedure Move_On (Plan : Plans.Plan; Along : Move; To : out Natural) is
      Id    : constant String := To_String (Along.Id);
      Since : constant Long_Float := Now;
   begin
      Heed (Plan, Along);
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
      Answer := Plan.Answer;
      Alarms.Heed (Plan.Bears);
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
            Look (Plan);
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

   --  Answer what has ended the plan; others need not wait for this robot any more.
   procedure End_Early (Plan : Plans.Plan; What : Event) is
   begin
      begin
         Step_Log.Write ("fault", To_String (Plan.Moves (Current).Id), """" & What'Image & """", Nothing);
      exception
         when Error : Step_Log.Unwritten =>
            Put_Line (Standard_Error, Exception_Message (Error));
      end;
      Gateway.Leave;
      Responses.Carry_Out (Plan, What, Answer);
   end End_Early;

   function Runs (Plan : Plans.Plan) return Boolean is
   begin
      Current := Plan.Start;
      Answer := Plan.Answer;
      Alarms.Heed (Plan.Bears);
      Carry_Out (Plan);
      Gateway.Leave;
      delay LIMIT_FAREWELL;
      return True;
   exception
      when Error : Failed =>
         End_Early (Plan, Event'Value (Exception_Message (Error)));
         return False;
      when Error : Gateway.Refused =>
         Put_Line (Standard_Error, Exception_Message (Error));
         End_Early (Plan, PEER_LOST);
         return False;
      when Error : Step_Log.Unwritten =>
         Put_Line (Standard_Error, Exception_Message (Error));
         End_Early (Plan, LOG_FAILED);
         return False;
      when Wire.Out_Of_Range =>
         Put_Line (Standard_Error, "leads where its bus can say nothing of");
         End_Early (Plan, NO_PROGRESS);
         return False;
      when Error : others =>
         Put_Line (Standard_Error, Exception_Information (Error));
         End_Early (Plan, CRASHED);
         return False;
   end Runs;

end Machine;
