with Ada.Exceptions; use Ada.Exceptions;
with Ada.Text_IO;    use Ada.Text_IO;
with Alarms;         use Alarms;
with Bus;
with Catalogue;      use Catalogue;
with Clocks;         use Clocks;
with Craft;          use Craft;
with Guards;
with Tables;         use Tables;
with Ways;

package body Responses is

   procedure Come_Up (Plan : Plans.Plan);
   procedure Hold (Plan : Plans.Plan);
   procedure Do_It (Plan : Plans.Plan; By : Response);
   function First (What : Event; Answer : Response_To) return Response;

   --  Come up, by thrust unless the dive was given up, as long as the bus is there. What floats rests there without
   --  thrust, for whoever swims to it.
   procedure Come_Up (Plan : Plans.Plan) is
   begin
      Vehicle.Begin_Goal ((Mode => MODE_SURFACE, others => <>));
      loop
         Guards.Kick;
         if Bus.Is_Gone or else Now - Vehicle.Told.Heard_At > LIMIT_UNHEARD then
            return;
         end if;
         exit when Vehicle.Told.Progress = PROGRESS_REACHED;
         exit when Now - Vehicle.Told.Known_At < LIMIT_STATE_SILENT
           and then Vehicle.Told.Here.Depth < Plan.Afloat + LIMIT_AFLOAT;
         delay LIMIT_PACE;
      end loop;
      if Plan.Floats then
         Vehicle.Begin_Goal ((Mode => MODE_IDLE, others => <>));
      end if;
   end Come_Up;

   --  Stay where the vehicle is, by thrust, until something else goes wrong or nobody is there any more.
   procedure Hold (Plan : Plans.Plan) is
   begin
      Ways.Hold;
      while not Bus.Is_Gone loop
         Pause (Plan);
         if Vehicle.Told.Progress = PROGRESS_FAILED then
            Fail (NO_PROGRESS, "cannot stay");
         end if;
      end loop;
   end Hold;

   procedure Do_It (Plan : Plans.Plan; By : Response) is
   begin
      case By is
         when Holds_Place | Goes_On =>
            Hold (Plan);

         when Backs_Out =>
            if Place_Is_Lost then
               Put_Line (Standard_Error, "without its place, it comes up");
            else
               Ways.Back_Out (Plan);
            end if;
            Come_Up (Plan);

         when Comes_Up =>
            Come_Up (Plan);

         when Stops_Thrust =>
            Vehicle.Begin_Goal ((Mode => MODE_IDLE, others => <>));
      end case;
   end Do_It;

   --  What is done first.
   function First (What : Event; Answer : Response_To) return Response is
     (if Answer (What) /= Goes_On then Answer (What) else Unbearable (What));

   procedure Carry_Out (Plan : Plans.Plan; What : Event; Answer : Response_To) is
      By    : Response := First (What, Answer);
      Other : Event;
   begin
      Answered (What);
      loop
         Put_Line (Standard_Error, "response: " & By'Image);
         begin
            Do_It (Plan, By);
            exit;
         exception
            when Error : Failed =>
               Other := Event'Value (Exception_Message (Error));
               Answered (Other);
               By := First (Other, Answer);
         end;
      end loop;
      delay LIMIT_FAREWELL;
   end Carry_Out;

end Responses;
