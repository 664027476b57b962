with Ada.Containers.Vectors;
with Ada.Strings.Unbounded; use Ada.Strings.Unbounded;
with Gateway;
with Sightings;
with Step_Log;

package body Slots is

   package Flags is new Ada.Containers.Vectors (Positive, Boolean);

   Active : Flags.Vector;

   procedure Prepare (Plan : Plans.Plan) is
   begin
      Active := Flags.To_Vector (False, Plan.Slots.Length);
   end Prepare;

   procedure Tell (Plan : Plans.Plan; Action : Plans.Action; Move : String; Wait : not null access procedure) is
   begin
      if Gateway.Is_Open then
         Gateway.Prepare (To_String (Action.Told), Action.Active, Sightings.Known (Plan));
         while Gateway.Granted = 0 loop
            Wait.all;
         end loop;
         Step_Log.Come_After (Gateway.Granted - 1);
         Step_Log.Write ("ntf", Move, To_String (Action.Detail), To_String (Action.Slots));
         Gateway.Send (Step_Log.Lamport);
         while not Gateway.Is_Set loop
            Wait.all;
         end loop;
         return;
      end if;
      for Each of Action.Sets loop
         Active.Replace_Element (Each, Action.Active);
      end loop;
      Step_Log.Write ("ntf", Move, To_String (Action.Detail), To_String (Action.Slots));
   end Tell;

   function Pass (Move : Plans.Move) return Boolean is
   begin
      if Move.Waits.Is_Empty then
         return True;
      elsif not Gateway.Is_Open then
         return (for all Each of Move.Waits => Active (Each));
      end if;
      Step_Log.Come_After (Gateway.Latest);
      return Gateway.Passes (To_String (Move.Awaited), Step_Log.Lamport + 1);
   end Pass;

   function Is_Hopeless (Move : Plans.Move) return Boolean is
     (Gateway.Is_Open and then Move.Senders /= "[]" and then Gateway.Are_Lost (To_String (Move.Senders)));

end Slots;
