package body Undecided is

   function Nobody_Says (Condition : String; Known : Craft.State) return Boolean is
     (raise Not_Decided
        with Condition & ": nobody says whether it holds, at a depth of" & Integer (Known.Here.Depth)'Image & " m");

end Undecided;
