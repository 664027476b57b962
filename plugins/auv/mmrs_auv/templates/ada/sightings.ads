--  What was detected: by this vehicle, and by robots that have notified it.
with Plans;

package Sightings is

   --  Where others have detected an object, its name in JSON; Told: whether they have, and said where.
   procedure Told_Of (Plan : Plans.Plan; Name : String; Told : out Boolean; Where : out Plans.Place);

   --  Whether this vehicle, or one that has notified it since, has detected an object.
   --  Raises Undecided.Not_Decided where nobody could.
   function Is_Found (Name : String) return Boolean;

   --  All that is known to have been detected, as notifies carry it: a list in JSON, ours last.
   function Known (Plan : Plans.Plan) return String;

end Sightings;
