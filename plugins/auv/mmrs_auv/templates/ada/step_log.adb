with Ada.Long_Float_Text_IO;
with Ada.Strings.Fixed;     use Ada.Strings.Fixed;
with Ada.Strings.Unbounded; use Ada.Strings.Unbounded;
with Clocks;
with GNAT.OS_Lib;           use GNAT.OS_Lib;
with Interfaces.C;

package body Step_Log is

   File        : File_Descriptor := Invalid_FD;
   Head        : Unbounded_String;
   Seq, Logical : Natural := 0;
   Offset, Latest : Long_Float := 0.0;

   function Fsync (Descriptor : Interfaces.C.int) return Interfaces.C.int
     with Import, Convention => C, External_Name => "fsync";

   function Whole (Item : Natural) return String is (Trim (Item'Image, Ada.Strings.Both));

   function Seconds return String;

   function Image (Item : Long_Float) return String is
      Found : String (1 .. 30);
   begin
      Ada.Long_Float_Text_IO.Put (Found, Item, Aft => 6, Exp => 0);
      return Trim (Found, Ada.Strings.Both);
   end Image;

   function Seconds return String is
   begin
      Latest := Long_Float'Max (Latest, Clocks.Passed + Offset);
      return Image (Latest);
   end Seconds;

   procedure Open (Path, Run, Robot : String) is
   begin
      File := Create_File (Path, Binary);
      if File = Invalid_FD then
         raise Unwritten with "cannot write " & Path;
      end if;
      Head := To_Unbounded_String ("{""run"":" & Run & ",""robot"":" & Robot & ",""seq"":");
   end Open;

   procedure Write (Label, Move, Detail, Slots : String) is
      Line : constant String :=
        To_String (Head) & Whole (Seq) & ",""lamport"":" & Whole (Logical + 1) & ",""time"":" & Seconds
        & ",""label"":""" & Label & """,""move"":" & Move & ",""detail"":" & Detail & ",""slot"":" & Slots
        & "}" & ASCII.LF;
   begin
      if Write (File, Line'Address, Line'Length) /= Line'Length then
         raise Unwritten with "cannot write the log";
      end if;
      if Interfaces.C."/=" (Fsync (Interfaces.C.int (File)), 0) then
         raise Unwritten with "cannot keep the log";
      end if;
      Seq := Seq + 1;
      Logical := Logical + 1;
   end Write;

   procedure Come_After (Lamport : Natural) is
   begin
      Logical := Natural'Max (Logical, Lamport);
   end Come_After;

   function Lamport return Natural is (Logical);

   procedure Shift (Seconds : Long_Float) is
   begin
      Offset := Seconds;
   end Shift;

   function Json (Item : String) return String is
      Found : Unbounded_String := To_Unbounded_String ("""");
      Digit : constant String := "0123456789abcdef";
   begin
      for Each of Item loop
         if Each in '"' | '\' then
            Append (Found, "\" & Each);
         elsif Each < ' ' or else Each = ASCII.DEL then
            Append (Found, "\u00" & Digit (Character'Pos (Each) / 16 + 1) & Digit (Character'Pos (Each) mod 16 + 1));
         else
            Append (Found, Each);
         end if;
      end loop;
      return To_String (Found) & """";
   end Json;

end Step_Log;
