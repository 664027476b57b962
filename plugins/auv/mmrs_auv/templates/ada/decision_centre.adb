with Ada.Directories;
with Ada.Exceptions;
with Ada.Strings.Unbounded; use Ada.Strings.Unbounded;
with Ada.Text_IO;           use Ada.Text_IO;
with Alarms;
with Bus;
with Clocks;
with Conditions;
with Craft;
with GNAT.OS_Lib;
with Gateway;
with Guards;
with Machine;
with Mission;
with Options;
with Plans;                 use Plans;
with Sight;
with Slots;
with Step_Log;
with Tables;
with Undecided;

--  The decision centre of one vehicle. Exit status: 0 at its end, 1 after a fault, 2 where it cannot begin.
procedure Decision_Centre is

   Most : constant Long_Float := 1.0E6;

   procedure Make_Sure_Of_Choices (Plan : Plans.Plan);

   --  Raise Options.Wrong where a choice of the plan is decided by nobody. Each condition is asked for, once.
   procedure Make_Sure_Of_Choices (Plan : Plans.Plan) is
      Nothing_Known : Craft.State;
      Holds         : Boolean;
      pragma Unreferenced (Holds);
   begin
      for Each of Plan.Moves loop
         if Each.Way = Chooses then
            begin
               Holds := Conditions.Holds (To_String (Each.Condition), Nothing_Known);
            exception
               when Error : Undecided.Not_Decided =>
                  raise Options.Wrong with Ada.Exceptions.Exception_Message (Error);
               when others =>
                  null;  --  what decides it needs to know more of the vehicle
            end;
         end if;
      end loop;
   end Make_Sure_Of_Choices;

   Plan : Plans.Plan;
   Step : Long_Float;

   --  Seconds to wait for the bus, and for the vehicle.
   Patience : Long_Float;
   Late : Long_Float := 0.0;
   Done : Boolean;
begin
   Options.Refuse_Others;
   Mission.Build (Plan);
   Step := Options.Number ("--depth-step", Plan.Step, Most);
   if Step = 0.0 then
      raise Options.Wrong
        with "nobody has said how the bus writes depths: --depth-step METRES, as its database says";
   end if;
   Craft.Set_Step (Step);
   Craft.Count_As_Lost (Options.Number ("--position-lost", Tables.LIMIT_POSITION_LOST, Most));
   Patience := Options.Number ("--patience", Tables.LIMIT_FIRST_SIGN, Most);
   Alarms.Be_Patient (Patience);
   Alarms.Keep_Clear (Options.Number ("--clearance", 0.0, Most));
   Slots.Prepare (Plan);
   if Options.Text ("--detections", "") /= "" then
      Sight.Belong_To (To_String (Plan.Eyes));
      Sight.Open (Natural (Options.Number ("--detections", 0.0, 65_535.0)));
   end if;
   Bus.Open
     (Options.Host, Options.Port, Options.Text ("--channel", "can0"), Patience);
   if not Plan.Alone then
      Gateway.Open (Options.Text ("--gateway", ""), To_String (Plan.Robots), Late);
   end if;
   Make_Sure_Of_Choices (Plan);
   Ada.Directories.Create_Path (Options.Text ("--logs", "logs"));
   Step_Log.Open
     (Options.Text ("--logs", "logs") & "/" & To_String (Plan.Log), Step_Log.Json (Options.Text ("--run", "run-0")),
      To_String (Plan.Robot));
   Step_Log.Shift (Late - Clocks.Passed);
   Guards.Begin_Work;
   Done := Machine.Runs (Plan);
   GNAT.OS_Lib.OS_Exit (if Done then 0 else 1);
exception
   when Error : others =>
      Put_Line (Standard_Error, Ada.Exceptions.Exception_Message (Error));
      GNAT.OS_Lib.OS_Exit (2);
end Decision_Centre;
