--  What cameras detect, as datagrams on this machine tell.
package Sight is

   --  Begin to hear. Raises GNAT.Sockets.Socket_Error.
   procedure Open (Port : Natural);

   --  Whether an object, its name in JSON, was detected twice at about the same place within a short time.
   --  Raises Undecided.Not_Decided where nobody listens.
   function Has_Seen (Name : String) return Boolean;

   --  Take a datagram; what is no detection is passed over.
   procedure Take (Line : String; Now : Long_Float);

end Sight;
