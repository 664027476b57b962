with Ada.Text_IO; use Ada.Text_IO;
with Bus;
with Clocks;      use Clocks;
with Craft;       use Craft;
with Gateway;
with Guards;
with Plans;       use Plans;

package body Alarms is

   --  Seconds of silence of the whole bus that count as loss.
   Silent : constant Long_Float := 2.0;

   --  Metres of uncertainty of one sigma above which the place counts as lost.
   Lost : constant Long_Float := 10.0;

   --  Seconds for which the vehicle may not know where it is, at first.
   Getting_Ready : constant Long_Float := 60.0;

   --  Since when events have lasted; Endless: they do not happen.
   Since : Seconds_Of := (others => Endless);

   procedure Watch (Plan : Plans.Plan; For_Event : Event; Happens : Boolean; Why : String);
   function Is_Ready return Boolean;

   procedure Fail (Event, Why : String) is
   begin
      Put_Line (Standard_Error, Event & ": " & Why);
      raise Failed with Event;
   end Fail;

   --  Raise Failed where an event has lasted as long as the plan says.
   procedure Watch (Plan : Plans.Plan; For_Event : Event; Happens : Boolean; Why : String) is
   begin
      if not Happens then
         Since (For_Event) := Endless;
         return;
      end if;
      Since (For_Event) := Long_Float'Min (Since (For_Event), Now);
      if Now - Since (For_Event) >= Plan.After (For_Event) then
         Fail (For_Event'Image, Why);
      end if;
   end Watch;

   procedure Look (Plan : Plans.Plan) is
      Known   : constant State := Vehicle.Told;
      Is_Mute : constant Boolean := Now - Known.Heard_At > Stale;
      Is_Lost : constant Boolean :=
        not Known.Trusted or else Now - Known.Known_At > Stale or else Known.Uncertainty > Lost;
      Is_Low  : constant Boolean := Known.Charge >= 0.0 and then Known.Charge < Plan.Reserve;
   begin
      Guards.Kick;
      if Known.Emergency /= 0 then
         Fail ("CRASHED", "the dive was given up, reason" & Known.Emergency'Image);
      elsif Bus.Is_Gone then
         Fail ("LINK_LOST", "the bus is gone");
      end if;
      Watch (Plan, LINK_LOST, Now - Known.Heard_At > Silent, "nothing is heard on the bus");
      Watch (Plan, POSITION_LOST, Is_Lost and not Is_Mute, "depth, heading or place are not known");
      Watch (Plan, BATTERY_LOW, Is_Low and not Is_Mute, "the battery has no more than the reserve");
   end Look;

   function Is_Ready return Boolean is
      Known : constant State := Vehicle.Told;
   begin
      return Known.Trusted and then Now - Known.Known_At < Stale and then Known.Uncertainty <= Lost;
   end Is_Ready;

   procedure Get_Ready is
      Until_Then : constant Long_Float := Now + Getting_Ready;
   begin
      while not Is_Ready loop
         Guards.Kick;
         if Bus.Is_Gone or else Now > Until_Then then
            if Bus.Is_Gone or else Now - Vehicle.Told.Heard_At > Silent then
               Fail ("LINK_LOST", "no vehicle is heard on its bus");
            end if;
            Fail ("POSITION_LOST", "the vehicle does not know where it is");
         end if;
         delay 0.05;
      end loop;
   end Get_Ready;

   procedure Pause (Plan : Plans.Plan) is
   begin
      Look (Plan);
      Gateway.Live;
      delay 0.05;
   end Pause;

end Alarms;
