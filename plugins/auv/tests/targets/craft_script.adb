with Ada.Text_IO; use Ada.Text_IO;
with Ada.Unchecked_Conversion;
with Craft;
with Interfaces;  use Interfaces;
with Listed;
with Plans;
with Sight;
with Tables;      use Tables;
with Tracks;
with Wire;

--  A decision centre's side of the bus that does what a script on standard input says, a line of answer for each.
--  Whole numbers are decimal, reals the bits of theirs and bytes in hexadecimal digits.
--
--    e MESSAGE COUNTER VALUES...   write a message of the list; "ID BYTES", or "refused"
--    d MESSAGE ID BYTES            read a frame as that message; its values, or "none"
--    v REAL                        set how many metres of depth a step is
--    l METRES                      set of what uncertainty on the place counts as lost
--    g MODE NORTH EAST DEPTH HEADING SPEED ALONG   begin a goal; "refused" where it cannot be said
--    o DEVICE ACTION PARAMETER     ask a device
--    x REASON                      give the dive up
--    h TIME ID BYTES               hear a frame
--    t TIME                        frames that are said then
--    s                             what is known
--    n TIME DATAGRAM               take what a camera tells
--    m KIND TO PLACE AWAY          add a move to the plan, which leads to one of that number; 0: to none
--    a NUMBER PLACE                come to a place by the move of that number
--    k PLACE                       the way back from there
--    f                             forget plan and places
--    p                             the figures of the list
--    r EVENT                       what is done where no policy is about it, and where one cannot be kept
--    u EVENT                       whether it is answered although another one is
--    w TIME NAME                   where an object is seen then, its name in JSON; "none" where it is not
procedure Craft_Script is

   function To_Real is new Ada.Unchecked_Conversion (Unsigned_64, Long_Float);
   function To_Bits is new Ada.Unchecked_Conversion (Long_Float, Unsigned_64);

   Line : String (1 .. 2000);
   Last : Natural;
   Next : Positive;
   Plan : Plans.Plan;

   function Word return String;
   function Whole return Natural is (Natural'Value (Word));
   function Real return Long_Float is (To_Real (Unsigned_64'Value ("16#" & Word & "#")));
   function Frame return Wire.Frame;
   procedure Tell (Value : Long_Float);
   procedure Tell (Item : Wire.Frame);
   procedure Write_Message;
   procedure Read_Message;
   procedure Begin_Goal;
   procedure Operate;
   procedure Say (Now : Long_Float);
   procedure Tell_State;
   procedure Look_For;
   function Place return Plans.Place;
   procedure Add_Move;
   procedure Pass;
   procedure Go_Back;
   procedure Tell_Figures;
   procedure Tell_Responses (What : Event);
   procedure Obey;

   function Word return String is
      First : constant Positive := Next;
   begin
      while Next <= Last and then Line (Next) /= ' ' loop
         Next := Next + 1;
      end loop;
      Next := Next + 1;
      return Line (First .. Next - 2);
   end Word;

   function Frame return Wire.Frame is
      Id    : constant Natural := Whole;
      Bytes : constant String := Word;
      Made  : Wire.Frame := (Id => Id, Length => Bytes'Length / 2, others => <>);
   begin
      for Index in 0 .. Made.Length - 1 loop
         Made.Data (Index) :=
           Unsigned_8'Value ("16#" & Bytes (Bytes'First + 2 * Index .. Bytes'First + 2 * Index + 1) & "#");
      end loop;
      return Made;
   end Frame;

   procedure Tell (Value : Long_Float) is
      Digit : constant String := "0123456789abcdef";
      Bits  : constant Unsigned_64 := To_Bits (Value);
   begin
      for Place in reverse 0 .. 15 loop
         Put (Digit (Natural (Shift_Right (Bits, 4 * Place) and 15) + 1));
      end loop;
      Put (' ');
   end Tell;

   procedure Tell (Item : Wire.Frame) is
      Digit : constant String := "0123456789abcdef";
   begin
      Put (Item.Id'Image & " ");
      for Byte of Item.Data (0 .. Item.Length - 1) loop
         Put (Digit (Natural (Byte / 16) + 1) & Digit (Natural (Byte mod 16) + 1));
      end loop;
      Put (' ');
   end Tell;

   --  The last two fields of a message are its counter and its check.
   procedure Write_Message is
      Message : constant Wire.Message := Listed.Messages (Whole);
      Counter : constant Unsigned_8 := Unsigned_8 (Whole);
      Made    : Wire.Frame := Wire.New_Frame (Message);
   begin
      for Field of Message.Fields (1 .. Message.Count - 2) loop
         Wire.Put (Made, Field, Real);
      end loop;
      Wire.Seal (Made, Message, Counter);
      Tell (Made);
   exception
      when Wire.Out_Of_Range =>
         Put ("refused");
   end Write_Message;

   procedure Read_Message is
      Message : constant Wire.Message := Listed.Messages (Whole);
      Heard   : constant Wire.Frame := Frame;
   begin
      if not Wire.Is_Sound (Heard, Message) then
         Put ("none");
         return;
      end if;
      for Field of Message.Fields (1 .. Message.Count - 1) loop
         Tell (Wire.Value (Heard, Field));
      end loop;
   end Read_Message;

   procedure Begin_Goal is
      Wanted : Craft.Goal;
   begin
      Wanted.Mode := Whole;
      Wanted.Where.North := Real;
      Wanted.Where.East := Real;
      Wanted.Where.Depth := Real;
      Wanted.Heading := Real;
      Wanted.Speed := Real;
      Wanted.Along := Whole = 1;
      Craft.Vehicle.Begin_Goal (Wanted);
   exception
      when Wire.Out_Of_Range =>
         Put ("refused");
   end Begin_Goal;

   procedure Operate is
      Device : constant Natural := Whole;
      Does   : constant Natural := Whole;
   begin
      Craft.Vehicle.Operate (Device, Does, Real);
   exception
      when Wire.Out_Of_Range =>
         Put ("refused");
   end Operate;

   procedure Say (Now : Long_Float) is
      Said  : Craft.Frames (1 .. Craft.Most_Frames);
      Count : Natural;
   begin
      Craft.Vehicle.Tick (Now, Said, Count);
      for Each of Said (1 .. Count) loop
         Tell (Each);
      end loop;
   end Say;

   procedure Tell_State is
      Known : constant Craft.State := Craft.Vehicle.Told;
   begin
      Tell (Known.Here.North);
      Tell (Known.Here.East);
      Tell (Known.Here.Depth);
      Tell (Known.Heading);
      Tell (Known.Uncertainty);
      Tell (Known.Charge);
      Tell (Known.Sonar);
      Tell (Known.Distance);
      Tell (Known.Heard_At);
      Tell (Known.Known_At);
      Put (Known.Trusted'Image & " " & Known.Leak'Image & " " & Craft.Is_Lost (Known)'Image);
      Put (Known.Progress'Image & Known.Emergency'Image & Known.Asked'Image & Known.Answer'Image);
   end Tell_State;

   procedure Look_For is
      Now   : constant Long_Float := Real;
      Seen  : Boolean;
      Where : Plans.Place;
   begin
      Sight.Look_For (Line (Next .. Last), Now, Seen, Where);
      if Seen then
         Tell (Where.North);
         Tell (Where.East);
         Tell (Where.Depth);
      else
         Put ("none");
      end if;
   end Look_For;

   function Place return Plans.Place is
      Found : Plans.Place;
   begin
      Found.North := Real;
      Found.East := Real;
      Found.Depth := Real;
      return Found;
   end Place;

   procedure Add_Move is
      Made : Plans.Move;
   begin
      Made.Kind := Plans.Move_Kind'Val (Whole);
      Made.To := Whole;
      Made.Way := (if Made.To = 0 then Plans.Ends else Plans.Takes);
      Made.Target := Place;
      Made.Away := Real;
      Plan.Moves.Append (Made);
   end Add_Move;

   procedure Pass is
      Number : constant Positive := Whole;
   begin
      Tracks.Pass (Number, Place);
   end Pass;

   procedure Go_Back is
   begin
      for Each of Tracks.Way_Back (Plan, Place) loop
         Tell (Each.North);
         Tell (Each.East);
         Tell (Each.Depth);
      end loop;
   end Go_Back;

   procedure Tell_Figures is
   begin
      for Each of Listed.Figures loop
         Tell (Each);
      end loop;
   end Tell_Figures;

   procedure Tell_Responses (What : Event) is
   begin
      Put (Undeclared (What)'Image & " " & Unbearable (What)'Image);
   end Tell_Responses;

   procedure Obey is
      Order : constant String := Word;
   begin
      case Order (Order'First) is
         when 'e' => Write_Message;
         when 'd' => Read_Message;
         when 'v' => Craft.Set_Step (Real);
         when 'l' => Craft.Count_As_Lost (Real);
         when 'g' => Begin_Goal;
         when 'o' => Operate;
         when 'x' => Craft.Vehicle.Give_Up (Whole);
         when 't' => Say (Real);
         when 's' => Tell_State;
         when 'n' =>
            declare
               Now : constant Long_Float := Real;
            begin
               Sight.Take (Line (Next .. Last), Now);
            end;
         when 'b' => Sight.Belong_To (Line (Next .. Last));
         when 'w' => Look_For;
         when 'm' => Add_Move;
         when 'a' => Pass;
         when 'k' => Go_Back;
         when 'p' => Tell_Figures;
         when 'r' => Tell_Responses (Event'Value (Word));
         when 'u' => Put (Overtakes (Lasting'Value (Word))'Image);
         when 'f' =>
            Tracks.Forget;
            Plan.Moves.Clear;
         when 'h' =>
            declare
               Now : constant Long_Float := Real;
            begin
               Craft.Vehicle.Hear (Frame, Now);
            end;
         when others =>
            raise Program_Error with Order;
      end case;
      New_Line;
   end Obey;

begin
   while not End_Of_File loop
      Get_Line (Line, Last);
      Next := 1;
      Obey;
   end loop;
end Craft_Script;
