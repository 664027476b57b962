--  Where the vehicle has been, and the way back by it: nobody has checked any other.
with Ada.Containers.Vectors;
with Plans; use type Plans.Place;

package Tracks is

   package Place_Lists is new Ada.Containers.Vectors (Positive, Plans.Place);

   --  Keep a place that the vehicle has come to, and the number of the move that ended there.
   procedure Pass (Move : Positive; Where : Plans.Place);

   function Is_Empty return Boolean;

   --  The place that was passed last.
   function Latest return Plans.Place;

   --  Begin anew.
   procedure Forget;

   --  Return the places by which the vehicle goes back to where the first place was, or on to the end of its
   --  plan where that is there and nearer. Cut short wherever it comes by a place twice.
   function Way_Back (Plan : Plans.Plan; Here : Plans.Place) return Place_Lists.Vector;

end Tracks;
