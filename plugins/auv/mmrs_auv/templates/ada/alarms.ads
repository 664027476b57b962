--  What may go wrong with a vehicle, whatever it does.
with Plans;
with Tables;

package Alarms is

   --  Its message is the event.
   Failed : exception;

   --  Raise Failed, and say why.
   procedure Fail (What : Tables.Event; Why : String);

   --  Bear events for so many seconds from now on.
   procedure Heed (Bears : Plans.Seconds_Of);

   --  Seconds that an event lasts before it counts.
   function Patience (What : Tables.Lasting) return Long_Float;

   --  An event is answered: it is not looked for any more, nor what cannot hinder the answer.
   procedure Answered (What : Tables.Event);

   --  Metres ahead within which sonar must see nothing.
   procedure Keep_Clear (Metres : Long_Float);

   --  Raise Failed where something has gone wrong; let the watchdog know that the machine lives.
   procedure Look (Plan : Plans.Plan);

   function Place_Is_Lost return Boolean;

   --  Seconds to wait for a vehicle's first sign.
   procedure Be_Patient (Seconds : Long_Float);

   --  Wait until the vehicle knows where it is. Raises Failed.
   procedure Get_Ready;

   --  Look, and let a moment go by. Raises Failed, Gateway.Refused.
   procedure Pause (Plan : Plans.Plan);

end Alarms;
