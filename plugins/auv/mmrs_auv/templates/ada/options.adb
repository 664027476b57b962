with Ada.Command_Line;  use Ada.Command_Line;
with Ada.Strings.Fixed; use Ada.Strings.Fixed;

package body Options is

   Most_Port : constant := 65_535;

   function Server return String is (Text ("--bus", ""));
   function Colon return Positive;

   procedure Refuse_Others is
   begin
      if Argument_Count mod 2 /= 0 then
         raise Wrong with Usage;
      end if;
      for Index in 1 .. Argument_Count / 2 loop
         declare
            Name : constant String := Argument (Index * 2 - 1);
         begin
            if Name'Length < 3 or else Head (Name, 2) /= "--" or else Ada.Strings.Fixed.Index (Usage, Name & " ") = 0
            then
               raise Wrong with "there is no option " & Name;
            end if;
         end;
      end loop;
   end Refuse_Others;

   function Text (Name, Otherwise : String) return String is
   begin
      for Index in 1 .. Argument_Count / 2 loop
         if Argument (Index * 2 - 1) = Name then
            return Argument (Index * 2);
         end if;
      end loop;
      return Otherwise;
   end Text;

   function Number (Name : String; Otherwise, Most : Long_Float) return Long_Float is
      Given : constant String := Text (Name, "");
      Found : Long_Float := Otherwise;
   begin
      if Given /= "" then
         Found := Long_Float'Value (Given);
      end if;
      if not (Found >= 0.0 and then Found <= Most) then
         raise Constraint_Error;
      end if;
      return Found;
   exception
      when Constraint_Error =>
         raise Wrong with Name & " " & Given & ": is no number, or out of range";
   end Number;

   function Colon return Positive is
      Found : constant Natural := Index (Server, ":", Ada.Strings.Backward);
   begin
      if Found = 0 then
         raise Wrong with Usage;
      end if;
      return Found;
   end Colon;

   function Host return String is (Server (1 .. Colon - 1));

   function Port return Positive is
      Given : constant String := Server (Colon + 1 .. Server'Last);
   begin
      if Positive'Value (Given) > Most_Port then
         raise Constraint_Error;
      end if;
      return Positive'Value (Given);
   exception
      when Constraint_Error =>
         raise Wrong with "--bus " & Server & ": is no HOST:PORT";
   end Port;

end Options;
