--  What cameras detect, as datagrams on this machine tell.
with Ada.Containers.Vectors;
with Plans;

package Sight is

   --  Begin to hear. Raises GNAT.Sockets.Socket_Error.
   procedure Open (Port : Natural);

   --  Pass over, from now on, what says that it is of another robot than this one, its name in JSON.
   procedure Belong_To (Robot : String);

   function Is_Open return Boolean;

   --  Where an object, its name in JSON, is seen now; Seen: whether it is.
   --  One detection counts for nothing: two must agree, and all that disagree with the middle are left out.
   procedure Look_For (Name : String; Now : Long_Float; Seen : out Boolean; Where : out Plans.Place);

   --  An object, its name in JSON, and where it was when it was seen last.
   type Thing is record
      Name  : Plans.Text;
      Where : Plans.Place;
   end record;

   package Thing_Lists is new Ada.Containers.Vectors (Positive, Thing);

   --  The objects that were seen so far, no more than so many.
   function Known_Things (Most : Positive) return Thing_Lists.Vector;

   --  Whether an object was ever seen.
   function Is_Known (Name : String) return Boolean;

   --  The same. Raises Undecided.Not_Decided where nobody listens.
   function Has_Seen (Name : String) return Boolean;

   --  Take a datagram; what is no detection is passed over.
   procedure Take (Line : String; Now : Long_Float);

end Sight;
