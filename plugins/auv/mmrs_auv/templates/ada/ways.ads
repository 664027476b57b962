--  How a vehicle goes from place to place, turns, and finds what it seeks.
with Plans;

package Ways is

   --  Go where the move of that number leads: to its object, wherever it is seen, where somebody looks for it.
   --  Raises Alarms.Failed.
   procedure Go (Plan : Plans.Plan; Number : Positive);

   --  Turn on the spot. Raises Alarms.Failed.
   procedure Turn (Plan : Plans.Plan; To : Plans.Move);

   --  Begin to stay where the vehicle is.
   procedure Hold;

   --  Go back by the way that the vehicle came. Raises Alarms.Failed.
   procedure Back_Out (Plan : Plans.Plan);

end Ways;
