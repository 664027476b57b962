with Ada.Text_IO; use Ada.Text_IO;
with Bus;
with Catalogue;   use Catalogue;
with Clocks;      use Clocks;
with Craft;       use Craft;
with Gateway;
with Guards;
with Plans;       use Plans;
with Tables;      use Tables;

package body Alarms is

   --  Seconds for which the vehicle may not know where it is, at first.
   First_Sign : Long_Float := LIMIT_FIRST_SIGN;

   --  Since when events have lasted; Endless: they do not happen.
   Since : Seconds_Of := (others => Endless);

   Borne     : Seconds_Of := (others => Endless);
   Clearance : Long_Float := 0.0;

   Is_Answering : Boolean := False;
   Answers      : array (Event) of Boolean := (others => False);

   procedure Watch (What : Lasting; Happens : Boolean; Why : String);
   procedure Look_At_Health (Known : State);
   function Is_Astray (Known : State) return Boolean;

   procedure Fail (What : Event; Why : String) is
   begin
      Put_Line (Standard_Error, What'Image & ": " & Why);
      raise Failed with What'Image;
   end Fail;

   procedure Heed (Bears : Seconds_Of) is
   begin
      Borne := Bears;
   end Heed;

   function Patience (What : Lasting) return Long_Float is (Borne (What));

   procedure Answered (What : Event) is
   begin
      Is_Answering := True;
      Answers (What) := True;
   end Answered;

   procedure Keep_Clear (Metres : Long_Float) is
   begin
      Clearance := Metres;
   end Keep_Clear;

   --  Raise Failed where an event has lasted for so long that it counts.
   procedure Watch (What : Lasting; Happens : Boolean; Why : String) is
   begin
      if not Happens then
         Since (What) := Endless;
         return;
      end if;
      Since (What) := Long_Float'Min (Since (What), Now);
      if not Answers (What)
        and then (Overtakes (What) or else not Is_Answering)
        and then Now - Since (What) >= Borne (What) then
         Fail (What, Why);
      end if;
   end Watch;

   procedure Look_At_Health (Known : State) is
   begin
      if Known.Health_At /= Never and then Now - Known.Health_At > LIMIT_HEALTH_SILENT then
         Vehicle.Give_Up (REASON_SENSORS_SILENT);
         Fail (CRASHED, "nobody tells of leaks and battery any more");
      end if;
   end Look_At_Health;

   function Is_Astray (Known : State) return Boolean is
     (Is_Lost (Known) or else Now - Known.Known_At > LIMIT_STATE_SILENT);

   function Place_Is_Lost return Boolean is (Is_Astray (Vehicle.Told));

   procedure Look (Plan : Plans.Plan) is
      Known   : constant State := Vehicle.Told;
      Is_Mute : constant Boolean := Now - Known.Heard_At > LIMIT_STATE_SILENT;
      Is_Low  : constant Boolean := Known.Charge >= 0.0 and then Known.Charge < Plan.Reserve;
   begin
      Guards.Kick;
      if Known.Emergency /= 0 and then not Answers (CRASHED) then
         Fail (CRASHED, "the dive was given up, reason" & Known.Emergency'Image);
      elsif Bus.Is_Gone then
         Fail (LINK_LOST, "the bus is gone");
      end if;
      Watch (LINK_LOST, Now - Known.Heard_At > LIMIT_BUS_SILENT, "nothing is heard on the bus");
      if not (Is_Mute or Answers (CRASHED)) then
         Look_At_Health (Known);
      end if;
      Watch (POSITION_LOST, Is_Astray (Known) and not Is_Mute, "depth, heading or place are not known");
      Watch (BATTERY_LOW, Is_Low and not Is_Mute, "the battery has no more than the reserve");
      Watch (OBSTACLE, Known.Sonar < Clearance and not Is_Mute, "sonar sees something ahead");
   end Look;

   procedure Be_Patient (Seconds : Long_Float) is
   begin
      First_Sign := Seconds;
   end Be_Patient;

   procedure Get_Ready is
      Until_Then : constant Long_Float := Now + First_Sign;
   begin
      while Place_Is_Lost loop
         Guards.Kick;
         if Bus.Is_Gone or else Now > Until_Then then
            if Bus.Is_Gone or else Now - Vehicle.Told.Heard_At > LIMIT_BUS_SILENT then
               Fail (LINK_LOST, "no vehicle is heard on its bus");
            end if;
            Fail (POSITION_LOST, "the vehicle does not know where it is");
         end if;
         delay LIMIT_PACE;
      end loop;
   end Get_Ready;

   procedure Pause (Plan : Plans.Plan) is
   begin
      Look (Plan);
      Gateway.Live;
      delay LIMIT_PACE;
   end Pause;

end Alarms;
