with Ada.Real_Time; use Ada.Real_Time;

package body Clocks is

   Began : constant Time := Clock;

   function Now return Long_Float is (Long_Float (To_Duration (Clock - Began)));

end Clocks;
