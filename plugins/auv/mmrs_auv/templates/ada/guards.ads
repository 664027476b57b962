--  What speaks for the machine, and what watches that both live.
package Guards is

   --  Begin to repeat goals on the bus, and to watch.
   procedure Begin_Work;

   --  To be called by the machine, more often than the patience of the watchdog lasts.
   procedure Kick;

   --  Whether the watchdog has given the dive up.
   function Has_Bitten return Boolean;

end Guards;
