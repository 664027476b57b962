with Ada.Numerics.Long_Elementary_Functions; use Ada.Numerics.Long_Elementary_Functions;

package body Plans is

   function Away (From, To : Place) return Long_Float is
     (Sqrt ((To.North - From.North) ** 2 + (To.East - From.East) ** 2 + (To.Depth - From.Depth) ** 2));

end Plans;
