--  Frames of CAN, and the fields in their bytes.
with Interfaces; use Interfaces;

package Wire is

   type Bytes is array (Natural range <>) of Unsigned_8;

   type Frame is record
      Id     : Natural := 0;
      Length : Natural range 0 .. 8 := 0;
      Data   : Bytes (0 .. 7) := (others => 0);
   end record;

   --  Value = raw * Scale; raw lies within Lowest .. Highest, values to be sent within Least .. Most.
   type Field is record
      Start, Bits     : Natural;
      Signed          : Boolean;
      Scale           : Long_Float;
      Lowest, Highest : Long_Long_Integer;
      Least, Most     : Long_Float;
   end record;

   type Field_List is array (Positive range <>) of Field;

   subtype Field_Count is Natural range 0 .. 8;

   --  A guarded message ends with a counter and a check over identifier and bytes.
   type Message (Count : Field_Count := 0) is record
      Id, Length : Natural;
      Guarded    : Boolean;
      Fields     : Field_List (1 .. Count);
   end record;

   Out_Of_Range : exception;

   function Check_Of (Id : Natural; Data : Bytes) return Unsigned_8;

   function New_Frame (Of_Message : Message) return Frame;

   --  Round to the nearest step, halves away from zero. Raises Out_Of_Range.
   procedure Put (Into : in out Frame; Where : Field; Value : Long_Float);

   --  Set counter and check.
   procedure Seal (Item : in out Frame; Of_Message : Message; Counter : Unsigned_8);

   --  Whether it is such a message, and can be believed: length, check, and what its fields hold.
   function Is_Sound (Item : Frame; Of_Message : Message) return Boolean;

   function Value (Item : Frame; Where : Field) return Long_Float;

   function Number (Item : Frame; Where : Field) return Natural;

end Wire;
