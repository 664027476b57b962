--  A CAN bus behind a socketcand server.
with Wire;

package Bus is

   Refused : exception;

   --  Connect and begin to hear. Raises Refused.
   procedure Open (Host : String; Port : Natural; Channel : String; Patience : Long_Float);

   procedure Send (Item : Wire.Frame);

   --  Whether the connection has ended.
   function Is_Gone return Boolean;

end Bus;
