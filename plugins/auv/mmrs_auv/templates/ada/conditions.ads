--  What decides the choices of the mission; its body is yours.
with Craft;

package Conditions is

   --  Return whether a condition holds, by what is known of the vehicle. An exception ends the dive.
   function Holds (Condition : String; Known : Craft.State) return Boolean;

end Conditions;
