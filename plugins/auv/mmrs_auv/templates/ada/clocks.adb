with Ada.Real_Time; use Ada.Real_Time;

package body Clocks is

   --  Seconds from one reading to the next that count.
   Most : constant Long_Float := 0.5;

   Began : constant Time := Clock;

   protected Awake is
      procedure Read (Found : out Long_Float);
   private
      Seen, Counted : Long_Float := 0.0;
   end Awake;

   function Passed return Long_Float is (Long_Float (To_Duration (Clock - Began)));

   protected body Awake is
      procedure Read (Found : out Long_Float) is
         Gone : constant Long_Float := Passed - Seen;
      begin
         Seen := Seen + Gone;
         Counted := Counted + Long_Float'Min (Gone, Most);
         Found := Counted;
      end Read;
   end Awake;

   function Now return Long_Float is
      Found : Long_Float;
   begin
      Awake.Read (Found);
      return Found;
   end Now;

end Clocks;
