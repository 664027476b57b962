--  What stands where nobody has said yet how a choice is decided.
with Craft;

package Undecided is

   Not_Decided : exception;

   --  It cannot be said yet: it is asked again.
   Not_Known : exception;

   --  Raises Not_Decided.
   function Nobody_Says (Condition : String; Known : Craft.State) return Boolean;

   --  Whether less than that part of the battery is left. Raises Not_Known where that was not told yet.
   function Is_Below (Known : Craft.State; Part : Long_Float) return Boolean;

end Undecided;
