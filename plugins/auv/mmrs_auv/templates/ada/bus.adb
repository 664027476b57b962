with Ada.Streams;  use Ada.Streams;
with Clocks;
with Craft;
with GNAT.Sockets; use GNAT.Sockets;
with Interfaces;   use Interfaces;
with Tables;       use Tables;

package body Bus is

   Link : Socket_Type;

   Lost : Boolean := False;
   pragma Atomic (Lost);

   task Listener is
      entry Begin_To_Hear;
   end Listener;

   protected type Turns is
      entry Take;
      procedure Give;
   private
      Free : Boolean := True;
   end Turns;

   Turn : Turns;

   type Reader is record
      Data        : Stream_Element_Array (1 .. 4096);
      Next, Last  : Stream_Element_Offset := 0;
   end record;

   Incoming : Reader;

   function Next_Character return Character;
   function Next_Word return String;
   procedure Say (Words : String);
   procedure Expect (Answer : String);
   procedure Take (Words : String);
   function Hex (Digit : Character) return Integer;

   protected body Turns is
      entry Take when Free is
      begin
         Free := False;
      end Take;

      procedure Give is
      begin
         Free := True;
      end Give;
   end Turns;

   function Next_Character return Character is
   begin
      if Incoming.Next >= Incoming.Last then
         Receive_Socket (Link, Incoming.Data, Incoming.Last);
         Incoming.Next := 0;
         if Incoming.Last < Incoming.Data'First then
            raise Refused with "the bus has ended the connection";
         end if;
      end if;
      Incoming.Next := Incoming.Next + 1;
      return Character'Val (Incoming.Data (Incoming.Next));
   end Next_Character;

   --  What stands between "< " and " >"; of one that is too long, nothing.
   function Next_Word return String is
      Found : String (1 .. LIMIT_WORD);
      Last  : Natural := 0;
      Fits  : Boolean := True;
      Each  : Character;
   begin
      while Next_Character /= '<' loop
         null;
      end loop;
      loop
         Each := Next_Character;
         exit when Each = '>';
         if Last < LIMIT_WORD then
            Last := Last + 1;
            Found (Last) := Each;
         else
            Fits := False;
         end if;
      end loop;
      return (if Fits and then Last >= 2 then Found (2 .. Last - 1) else "");
   end Next_Word;

   procedure Say (Words : String) is
      Data : Stream_Element_Array (1 .. Words'Length);
      Sent : Stream_Element_Offset := 0;
      Last : Stream_Element_Offset;
   begin
      for Index in Words'Range loop
         Data (Stream_Element_Offset (Index - Words'First + 1)) := Character'Pos (Words (Index));
      end loop;
      while Sent < Data'Last loop
         Send_Socket (Link, Data (Sent + 1 .. Data'Last), Last);
         Sent := Last;
      end loop;
   end Say;

   procedure Expect (Answer : String) is
      Word : constant String := Next_Word;
   begin
      if Word /= Answer then
         raise Refused with "expected '" & Answer & "' of the bus, heard '" & Word & "'";
      end if;
   end Expect;

   function Hex (Digit : Character) return Integer is
     (case Digit is
        when '0' .. '9' => Character'Pos (Digit) - Character'Pos ('0'),
        when 'A' .. 'F' => Character'Pos (Digit) - Character'Pos ('A') + 10,
        when 'a' .. 'f' => Character'Pos (Digit) - Character'Pos ('a') + 10,
        when others => -1);

   --  Hear "frame ID TIME BYTES"; what is no such word is passed over.
   procedure Take (Words : String) is
      Item  : Wire.Frame;
      Place : Natural := Words'First + 6;
      Digit : Integer;
      Half  : Natural := 0;
   begin
      if Words'Length < 8 or else Words (Words'First .. Words'First + 5) /= "frame " then
         return;
      end if;
      while Place <= Words'Last and then Words (Place) /= ' ' loop
         Digit := Hex (Words (Place));
         if Digit < 0 or else Item.Id > 16#7FF# then
            return;
         end if;
         Item.Id := Item.Id * 16 + Digit;
         Place := Place + 1;
      end loop;
      if Place - Words'First - 6 > 3 then
         return;  --  an extended identifier, of whatever number
      end if;
      Place := Place + 1;
      while Place <= Words'Last and then Words (Place) /= ' ' loop
         Place := Place + 1;
      end loop;
      for Index in Place + 1 .. Words'Last loop
         if Words (Index) /= ' ' then
            Digit := Hex (Words (Index));
            if Digit < 0 or else Half > 15 then
               return;
            end if;
            Item.Data (Half / 2) := Item.Data (Half / 2) * 16 + Unsigned_8 (Digit);
            Half := Half + 1;
         end if;
      end loop;
      Item.Length := Half / 2;
      Craft.Vehicle.Hear (Item, Clocks.Now);
   end Take;

   procedure Open (Host : String; Port : Natural; Channel : String; Patience : Long_Float) is
      Address : Sock_Addr_Type;
      Until_Then : constant Long_Float := Clocks.Passed + Patience;
   begin
      Address.Port := Port_Type (Port);
      Address.Addr := Addresses (Get_Host_By_Name (Host), 1);
      loop
         begin
            Create_Socket (Link);
            Connect_Socket (Link, Address);
            exit;
         exception
            when Socket_Error =>
               Close_Socket (Link);
               if Clocks.Passed > Until_Then then
                  raise Refused with "no bus at " & Image (Address);
               end if;
               delay 0.2;
         end;
      end loop;
      Set_Socket_Option (Link, IP_Protocol_For_TCP_Level, (No_Delay, True));
      Set_Socket_Option (Link, Socket_Level, (Send_Timeout, 1.0));
      Expect ("hi");
      Say ("< open " & Channel & " >");
      Expect ("ok");
      Say ("< rawmode >");
      Expect ("ok");
      Listener.Begin_To_Hear;
   exception
      when Socket_Error | Host_Error =>
         raise Refused with "no bus at " & Host;
   end Open;

   procedure Send (Item : Wire.Frame) is
      Digit : constant String := "0123456789ABCDEF";
      Words : String (1 .. 64) := (others => ' ');
      Last  : Natural := 0;

      procedure Add (More : String);
      procedure Add_Hex (Value : Natural; Places : Positive);

      procedure Add (More : String) is
      begin
         Words (Last + 1 .. Last + More'Length) := More;
         Last := Last + More'Length;
      end Add;

      procedure Add_Hex (Value : Natural; Places : Positive) is
      begin
         for Index in reverse 0 .. Places - 1 loop
            Add ((1 => Digit (Value / 16 ** Index mod 16 + 1)));
         end loop;
      end Add_Hex;
   begin
      if Lost then
         return;
      end if;
      Add ("< send ");
      Add_Hex (Item.Id, 3);
      Add (" ");
      Add_Hex (Item.Length, 1);
      for Index in 0 .. Item.Length - 1 loop
         Add (" ");
         Add_Hex (Natural (Item.Data (Index)), 2);
      end loop;
      Add (" >");
      Turn.Take;
      begin
         Say (Words (1 .. Last));
      exception
         when Socket_Error =>
            Lost := True;
      end;
      Turn.Give;
   end Send;

   function Is_Gone return Boolean is (Lost);

   task body Listener is
   begin
      select
         accept Begin_To_Hear;
      or
         terminate;
      end select;
      loop
         Take (Next_Word);
      end loop;
   exception
      when others =>
         Lost := True;
   end Listener;

end Bus;
