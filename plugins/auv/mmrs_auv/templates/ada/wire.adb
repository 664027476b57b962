package body Wire is

   --  SAE J1850: the polynomial without its highest bit.
   Polynomial : constant Unsigned_8 := 16#1D#;

   function Next (Crc, Byte : Unsigned_8) return Unsigned_8;
   function Packed (Item : Frame) return Unsigned_64;
   function Raw (Item : Frame; Where : Field) return Long_Long_Integer;

   function Next (Crc, Byte : Unsigned_8) return Unsigned_8 is
      Found : Unsigned_8 := Crc xor Byte;
   begin
      for Bit in 1 .. 8 loop
         if (Found and 16#80#) /= 0 then
            Found := Shift_Left (Found, 1) xor Polynomial;
         else
            Found := Shift_Left (Found, 1);
         end if;
      end loop;
      return Found;
   end Next;

   function Check_Of (Id : Natural; Data : Bytes) return Unsigned_8 is
      Crc : Unsigned_8 := 16#FF#;
   begin
      Crc := Next (Crc, Unsigned_8 (Id mod 256));
      Crc := Next (Crc, Unsigned_8 (Id / 256 mod 256));
      for Byte of Data loop
         Crc := Next (Crc, Byte);
      end loop;
      return Crc xor 16#FF#;
   end Check_Of;

   function New_Frame (Of_Message : Message) return Frame is
     (Id => Of_Message.Id, Length => Of_Message.Length, Data => (others => 0));

   procedure Put (Into : in out Frame; Where : Field; Value : Long_Float) is
      Whole : Long_Long_Integer;
      Image : Unsigned_64;
      Bit   : Natural;
   begin
      if not Value'Valid or else not (Value >= Where.Least and then Value <= Where.Most) then
         raise Out_Of_Range with "a value is beyond what a message holds";
      end if;
      Whole := Long_Long_Integer (Long_Float'Rounding (Value / Where.Scale));
      Whole := Long_Long_Integer'Max (Where.Lowest, Long_Long_Integer'Min (Where.Highest, Whole));
      Image := (if Whole < 0 then not Unsigned_64 (-Whole) + 1 else Unsigned_64 (Whole));
      for Index in 0 .. Where.Bits - 1 loop
         Bit := Where.Start + Index;
         if (Shift_Right (Image, Index) and 1) = 1 then
            Into.Data (Bit / 8) := Into.Data (Bit / 8) or Shift_Left (Unsigned_8 (1), Bit mod 8);
         end if;
      end loop;
   end Put;

   procedure Seal (Item : in out Frame; Of_Message : Message; Counter : Unsigned_8) is
      Last : constant Natural := Of_Message.Length - 1;
   begin
      Item.Data (Last - 1) := Counter;
      Item.Data (Last) := Check_Of (Item.Id, Item.Data (0 .. Last - 1));
   end Seal;

   function Is_Sound (Item : Frame; Of_Message : Message) return Boolean is
     (Item.Id = Of_Message.Id
      and then Item.Length = Of_Message.Length
      and then
        (not Of_Message.Guarded
         or else Item.Data (Item.Length - 1)
                 = Check_Of (Item.Id, Item.Data (0 .. Item.Length - 2)))
      and then (for all Each of Of_Message.Fields => Raw (Item, Each) in Each.Lowest .. Each.Highest));

   function Packed (Item : Frame) return Unsigned_64 is
      Found : Unsigned_64 := 0;
   begin
      for Index in reverse Item.Data'Range loop
         Found := Shift_Left (Found, 8) or Unsigned_64 (Item.Data (Index));
      end loop;
      return Found;
   end Packed;

   function Raw (Item : Frame; Where : Field) return Long_Long_Integer is
      Mask  : constant Unsigned_64 := Shift_Left (Unsigned_64 (1), Where.Bits) - 1;
      Image : constant Unsigned_64 := Shift_Right (Packed (Item), Where.Start) and Mask;
   begin
      if Where.Signed and then Shift_Right (Image, Where.Bits - 1) = 1 then
         return Long_Long_Integer (Image) - Long_Long_Integer (Mask) - 1;
      end if;
      return Long_Long_Integer (Image);
   end Raw;

   function Value (Item : Frame; Where : Field) return Long_Float is
     (Long_Float (Raw (Item, Where)) * Where.Scale);

   function Number (Item : Frame; Where : Field) return Natural is
     (Natural (Long_Long_Integer'Max (0, Raw (Item, Where))));

end Wire;
