with Ada.Numerics.Long_Elementary_Functions; use Ada.Numerics.Long_Elementary_Functions;

package body Plans is

   function Away (From, To : Place) return Long_Float is
     (Sqrt ((To.North - From.North) ** 2 + (To.East - From.East) ** 2 + (To.Depth - From.Depth) ** 2));

   function Short_Of (From, To : Place; Metres : Long_Float) return Place is
      Way  : constant Long_Float := Away (From, To);
      Part : constant Long_Float := (if Way <= Metres then 0.0 else (Way - Metres) / Way);
   begin
      if Metres <= 0.0 then
         return To;
      end if;
      return (North => From.North + Part * (To.North - From.North),
              East  => From.East + Part * (To.East - From.East),
              Depth => From.Depth + Part * (To.Depth - From.Depth));
   end Short_Of;

end Plans;
