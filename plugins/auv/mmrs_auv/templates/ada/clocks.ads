--  Seconds by a clock that nobody sets.
package Clocks is

   --  Since the program began, without stalls of it. What came during one still waits to be heard, so that it is
   --  nobody's silence; somebody has to ask more often than every half second.
   function Now return Long_Float;

   --  Since the program began, with all stalls, as those who wait for it count.
   function Passed return Long_Float;

end Clocks;
