package body Undecided is

   function Nobody_Says (Condition : String; Known : Craft.State) return Boolean is
      pragma Unreferenced (Known);
   begin
      return raise Not_Decided with Condition & ": nobody says whether it holds, in conditions.adb";
   end Nobody_Says;

   function Is_Below (Known : Craft.State; Part : Long_Float) return Boolean is
   begin
      if Known.Charge < 0.0 then
         raise Not_Known with "nobody says how much of the battery is left";
      end if;
      return Known.Charge < Part;
   end Is_Below;

end Undecided;
