--  What may go wrong with a vehicle, whatever it does.
with Plans;

package Alarms is

   --  Its message is the event, in the words of policies.
   Failed : exception;

   --  Raise Failed, and say why.
   procedure Fail (Event, Why : String);

   --  Raise Failed where something has gone wrong; let the watchdog know that the machine lives.
   procedure Look (Plan : Plans.Plan);

   --  Wait until the vehicle knows where it is. Raises Failed.
   procedure Get_Ready;

   --  Look, and let a moment go by. Raises Failed, Gateway.Refused.
   procedure Pause (Plan : Plans.Plan);

   --  Seconds of silence of the sensor controller that count as loss.
   Stale : constant Long_Float := 1.0;

end Alarms;
