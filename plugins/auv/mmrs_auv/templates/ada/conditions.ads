--  What decides the choices of the mission; its body is yours.
with Craft;

package Conditions is

   --  Return whether a condition holds, by what is known of the vehicle. Each is asked for once before the dive, when
   --  nothing is known yet. An exception in the dive is the fault CONDITION_FAILED.
   function Holds (Condition : String; Known : Craft.State) return Boolean;

end Conditions;
