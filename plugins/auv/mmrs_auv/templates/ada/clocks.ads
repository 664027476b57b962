--  Seconds since the program began, by a clock that nobody sets.
package Clocks is

   function Now return Long_Float;

end Clocks;
