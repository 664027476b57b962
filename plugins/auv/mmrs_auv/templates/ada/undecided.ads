--  What stands where nobody has said yet how a choice is decided.
with Craft;

package Undecided is

   Not_Decided : exception;

   --  Raises Not_Decided.
   function Nobody_Says (Condition : String; Known : Craft.State) return Boolean;

end Undecided;
