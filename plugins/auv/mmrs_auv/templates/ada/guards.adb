with Ada.Real_Time; use Ada.Real_Time;
with Ada.Text_IO;
with Bus;
with Catalogue;
with Clocks;
with Craft;
with Tables;        use Tables;

package body Guards is

   Period : constant Time_Span := To_Time_Span (LIMIT_GOAL_PERIOD);

   type Worker is (Machine, Speaker);
   type Instants is array (Worker) of Long_Float;

   protected Dog is
      procedure Pat (By : Worker; Now : Long_Float);
      procedure Look (Now : Long_Float; Bites : out Boolean);
      function Bitten return Boolean;
   private
      Last  : Instants := (others => Long_Float'Last);
      Fired : Boolean := False;
   end Dog;

   task Speaking is
      entry Go;
   end Speaking;

   task Watching is
      entry Go;
   end Watching;

   procedure Speak;

   protected body Dog is
      procedure Pat (By : Worker; Now : Long_Float) is
      begin
         Last (By) := Now;
      end Pat;

      procedure Look (Now : Long_Float; Bites : out Boolean) is
      begin
         Bites := (for some Each of Last => Now - Each > LIMIT_WATCHDOG);
         Fired := Fired or Bites;
      end Look;

      function Bitten return Boolean is (Fired);
   end Dog;

   procedure Begin_Work is
   begin
      Kick;
      Dog.Pat (Speaker, Clocks.Now);
      Speaking.Go;
      Watching.Go;
   end Begin_Work;

   procedure Kick is
   begin
      Dog.Pat (Machine, Clocks.Now);
   end Kick;

   function Has_Bitten return Boolean is (Dog.Bitten);

   procedure Speak is
      Said : Craft.Frames (1 .. Craft.Most_Frames);
      Last : Natural;
   begin
      Craft.Vehicle.Tick (Clocks.Now, Said, Last);
      for Each of Said (1 .. Last) loop
         Bus.Send (Each);
      end loop;
   end Speak;

   task body Speaking is
      Due : Time;
   begin
      select
         accept Go;
      or
         terminate;
      end select;
      Due := Clock;
      loop
         Speak;
         Dog.Pat (Speaker, Clocks.Now);
         Due := Due + Period;
         Due := (if Due < Clock then Clock else Due);
         delay until Due;
      end loop;
   exception
      when others =>
         Ada.Text_IO.Put_Line (Ada.Text_IO.Standard_Error, "the goals are no longer said");
   end Speaking;

   task body Watching is
      Bites : Boolean;
   begin
      select
         accept Go;
      or
         terminate;
      end select;
      loop
         delay 0.1;
         Dog.Look (Clocks.Now, Bites);
         if Bites then
            Craft.Vehicle.Give_Up (Catalogue.REASON_COMMANDS_SILENT);
            Speak;
         end if;
      end loop;
   end Watching;

end Guards;
