--  How a vehicle goes from place to place, turns, and finds what it seeks.
with Plans;

package Ways is

   --  Go where a move leads: to its object, wherever it is seen, where somebody looks for it.
   --  Raises Alarms.Failed.
   procedure Go (Plan : Plans.Plan; Along : Plans.Move);

   --  Turn on the spot. Raises Alarms.Failed.
   procedure Turn (Plan : Plans.Plan; To : Plans.Move);

end Ways;
