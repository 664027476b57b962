with Ada.Command_Line;      use Ada.Command_Line;
with Ada.Directories;
with Ada.Exceptions;
with Ada.Strings.Fixed;
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
with Plans;                 use Plans;
with Sight;
with Slots;
with Step_Log;
with Undecided;

--  The decision centre of one vehicle. Exit status: 0 at its end, 1 after a fault, 2 where it cannot begin.
procedure Decision_Centre is

   Wrong : exception;

   function Option (Name, Otherwise : String) return String;
   procedure Make_Sure_Of_Choices (Plan : Plans.Plan);

   function Option (Name, Otherwise : String) return String is
   begin
      for Index in 1 .. Argument_Count / 2 loop
         if Argument (Index * 2 - 1) = Name then
            return Argument (Index * 2);
         end if;
      end loop;
      return Otherwise;
   end Option;

   --  Raise Wrong where a choice of the plan is decided by nobody. Each condition is asked for, once.
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
                  raise Wrong with Ada.Exceptions.Exception_Message (Error);
               when others =>
                  null;  --  what decides it needs to know more of the vehicle
            end;
         end if;
      end loop;
   end Make_Sure_Of_Choices;

   Usage : constant String :=
     "decision_centre --bus HOST:PORT [--channel can0] [--logs FOLDER] [--run ID] [--patience SECONDS] "
     & "[--depth-step METRES] [--gateway FILE] [--detections PORT] [--clearance METRES]";

   Server : constant String := Option ("--bus", "");
   Colon  : constant Natural := Ada.Strings.Fixed.Index (Server, ":", Ada.Strings.Backward);
   Logs   : constant String := Option ("--logs", "logs");
   Plan   : Plans.Plan;
   Step   : Long_Float;
   Late   : Long_Float := 0.0;
   Done   : Boolean;
begin
   if Colon = 0 or else Argument_Count mod 2 /= 0 then
      raise Wrong with Usage;
   end if;
   Mission.Build (Plan);
   Step := Long_Float'Value (Option ("--depth-step", Plan.Step'Image));
   if Step <= 0.0 then
      raise Wrong with "nobody has said how the bus writes depths: --depth-step METRES, as its database says";
   end if;
   Craft.Set_Step (Step);
   Slots.Prepare (Plan);
   Ada.Directories.Create_Path (Logs);
   Step_Log.Open
     (Logs & "/" & To_String (Plan.Log), Step_Log.Json (Option ("--run", "run-0")), To_String (Plan.Robot));
   Bus.Open
     (Server (Server'First .. Colon - 1),
      Natural'Value (Server (Colon + 1 .. Server'Last)),
      Option ("--channel", "can0"),
      Long_Float'Value (Option ("--patience", "5.0")));
   if not Plan.Alone then
      Gateway.Open (Option ("--gateway", ""), To_String (Plan.Robots), Late);
   end if;
   Alarms.Keep_Clear (Long_Float'Value (Option ("--clearance", "0.0")));
   if Option ("--detections", "") /= "" then
      Sight.Open (Natural'Value (Option ("--detections", "")));
   end if;
   Make_Sure_Of_Choices (Plan);
   Step_Log.Shift (Late - Clocks.Now);
   Guards.Begin_Work;
   Done := Machine.Runs (Plan);
   GNAT.OS_Lib.OS_Exit (if Done then 0 else 1);
exception
   when Error : others =>
      Put_Line (Standard_Error, Ada.Exceptions.Exception_Message (Error));
      GNAT.OS_Lib.OS_Exit (2);
end Decision_Centre;
