with Ada.Containers.Vectors;
with Ada.Strings.Unbounded; use Ada.Strings.Unbounded;
with Step_Log;

package body Slots is

   package Flags is new Ada.Containers.Vectors (Positive, Boolean);

   Active : Flags.Vector;

   procedure Prepare (Plan : Plans.Plan) is
   begin
      Active := Flags.To_Vector (False, Plan.Slots.Length);
   end Prepare;

   procedure Tell (Action : Plans.Action; Move : String) is
   begin
      for Each of Action.Sets loop
         Active.Replace_Element (Each, Action.Active);
      end loop;
      Step_Log.Write ("ntf", Move, To_String (Action.Detail), To_String (Action.Slots));
   end Tell;

   function Pass (Move : Plans.Move) return Boolean is
     (for all Each of Move.Waits => Active (Each));

end Slots;
