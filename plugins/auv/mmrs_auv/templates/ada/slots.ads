--  The slots of a robot: its own where it is alone, else as the gateway of the bus between robots tells.
with Plans;

package Slots is

   procedure Prepare (Plan : Plans.Plan);

   --  Set slots, and log that.
   procedure Tell (Action : Plans.Action; Move : String);

   --  Return whether all slots that a move waits for are active.
   function Pass (Move : Plans.Move) return Boolean;

end Slots;
