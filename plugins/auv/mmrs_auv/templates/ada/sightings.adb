with Ada.Strings.Fixed;     use Ada.Strings.Fixed;
with Ada.Strings.Unbounded; use Ada.Strings.Unbounded;
with Gateway;
with Plans;                 use Plans;
with Sight;
with Step_Log;
with Tables;                use Tables;
with Undecided;

package body Sightings is

   function After_Name (Finds, Name : String) return Natural;
   function Number_At (Line : String; From : Positive) return Long_Float;

   --  Where in a list of finds the place of an object begins; 0: it is not in it.
   function After_Name (Finds, Name : String) return Natural is
      Mark  : constant String := "[" & Name & ", ";
      Found : constant Natural := Index (Finds, Mark);
   begin
      return (if Found = 0 then 0 else Found + Mark'Length);
   end After_Name;

   function Number_At (Line : String; From : Positive) return Long_Float is
      Last : Natural := From - 1;
   begin
      while Last < Line'Last and then Line (Last + 1) not in ',' | ']' loop
         Last := Last + 1;
      end loop;
      return Long_Float'Value (Line (From .. Last));
   end Number_At;

   procedure Told_Of (Plan : Plans.Plan; Name : String; Told : out Boolean; Where : out Place) is
      Finds        : constant String := Gateway.Finds;
      First        : constant Natural := After_Name (Finds, Name);
      Second, Last : Natural;
   begin
      Where := (others => <>);
      Told := First > 0 and then Finds (First) = '[';
      if Told then
         Second := Index (Finds, ", ", First) + 2;
         Last := Index (Finds, ", ", Second) + 2;
         Where :=
           (North => Number_At (Finds, Second),
            East  => Number_At (Finds, First + 1),
            Depth => Plan.Surface - Number_At (Finds, Last));
      end if;
   end Told_Of;

   function Is_Found (Name : String) return Boolean is
   begin
      if not (Sight.Is_Open or Gateway.Is_Open) then
         raise Undecided.Not_Decided with "nobody could find " & Name & ": --detections PORT, --gateway FILE";
      end if;
      return Sight.Is_Known (Name) or else After_Name (Gateway.Finds, Name) > 0;
   end Is_Found;

   function Known (Plan : Plans.Plan) return String is
      Found : Unbounded_String := To_Unbounded_String (Gateway.Finds);

      procedure Add (Name : String; Where : Place);

      procedure Add (Name : String; Where : Place) is
      begin
         Append
           (Found,
            (if Found = "" then "" else ", ") & "[" & Name & ", [" & Step_Log.Image (Where.East) & ", "
            & Step_Log.Image (Where.North) & ", " & Step_Log.Image (Plan.Surface - Where.Depth) & "]]");
      end Add;
   begin
      for Each of Sight.Known_Things (LIMIT_FINDS) loop
         Add (To_String (Each.Name), Each.Where);
      end loop;
      return "[" & To_String (Found) & "]";
   end Known;

end Sightings;
