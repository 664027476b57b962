--  What stands where nobody has said yet how a choice is decided.
with Craft;

package Undecided is

   Not_Decided : exception;

   --  Raises Not_Decided.
   function Nobody_Says (Condition : String; Known : Craft.State) return Boolean;

   --  Whether less than that part of the battery is left. Raises Not_Decided where that was never told.
   function Is_Below (Known : Craft.State; Part : Long_Float) return Boolean;

end Undecided;
