--  The slots of a robot: its own where it is alone, else as the gateway of the bus between robots tells.
with Plans;

package Slots is

   procedure Prepare (Plan : Plans.Plan);

   --  Set slots, and log that; Wait is called again and again until all their owners know.
   procedure Tell (Plan : Plans.Plan; Action : Plans.Action; Move : String; Wait : not null access procedure);

   --  Return whether all slots that a move waits for are active.
   function Pass (Move : Plans.Move) return Boolean;

   --  Return whether nobody is left who could set what a move waits for.
   function Is_Hopeless (Move : Plans.Move) return Boolean;

end Slots;
