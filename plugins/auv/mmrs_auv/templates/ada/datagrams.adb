with Ada.Strings.Fixed;                    use Ada.Strings.Fixed;
with Ada.Strings.Unbounded;                use Ada.Strings.Unbounded;
with Ada.Strings.UTF_Encoding;             use Ada.Strings.UTF_Encoding;
with Ada.Strings.UTF_Encoding.Conversions; use Ada.Strings.UTF_Encoding.Conversions;
with Tables;                               use Tables;

package body Datagrams is

   subtype High_Half is Natural range 16#D800# .. 16#DBFF#;
   subtype Low_Half is Natural range 16#DC00# .. 16#DFFF#;

   function After_Blanks (Line : String; From : Positive) return Positive;
   function Value_In (Line, Key : String) return Natural;
   function Value_Of (Line, Key : String) return Positive;
   function Body_Of (Line : String; First : Positive) return String;
   function Written (Code : Natural) return String;

   --  Where the next character stands that is no blank.
   function After_Blanks (Line : String; From : Positive) return Positive is
     (if From > Line'Last then raise Constraint_Error
      elsif Line (From) in ' ' | ASCII.HT | ASCII.LF | ASCII.CR then After_Blanks (Line, From + 1)
      else From);

   --  Where a key's value begins; 0: the key is missing.
   function Value_In (Line, Key : String) return Natural is
      Mark  : constant String := """" & Key & """";
      Place : Natural := Index (Line, Mark);
      Next  : Positive;
   begin
      while Place > 0 loop
         Next := After_Blanks (Line, Place + Mark'Length);
         if Line (Next) = ':' then
            return After_Blanks (Line, Next + 1);
         end if;
         Place := Index (Line, Mark, Place + 1);
      end loop;
      return 0;
   end Value_In;

   --  The same. Raises Constraint_Error where the key is missing.
   function Value_Of (Line, Key : String) return Positive is (Value_In (Line, Key));

   function Number_Of (Line, Key : String; Low, High : Long_Float) return Long_Float is
      First : constant Positive := Value_Of (Line, Key);
      Last  : Natural := First - 1;
      Found : Long_Float;
   begin
      while Last < Line'Last and then Line (Last + 1) in '0' .. '9' | '+' | '-' | '.' | 'e' | 'E' loop
         Last := Last + 1;
      end loop;
      Found := Long_Float'Value (Line (First .. Last));
      if Line (After_Blanks (Line, Last + 1)) not in ',' | '}' or else not (Found >= Low and then Found <= High) then
         raise Constraint_Error;
      end if;
      return Found;
   end Number_Of;

   --  What stands between the quotes of a text that begins there.
   function Body_Of (Line : String; First : Positive) return String is
      Last : Positive := First + 1;
   begin
      if Line (First) /= '"' then
         raise Constraint_Error;
      end if;
      while Line (Last) /= '"' loop
         Last := Last + (if Line (Last) = '\' then 2 else 1);
      end loop;
      return Line (First + 1 .. Last - 1);
   end Body_Of;

   --  Sixteen bits of a name in JSON.
   function Written (Code : Natural) return String is
      Digit : constant String := "0123456789abcdef";
      Found : String := "\u0000";
      Left  : Natural := Code;
   begin
      if Code < 32 or else Code in 127 .. 159 then
         raise Constraint_Error;
      elsif Code < 127 then
         return (if Character'Val (Code) in '"' | '\' then "\" else "") & Character'Val (Code);
      end if;
      for Place in reverse 3 .. 6 loop
         Found (Place) := Digit (Left mod 16 + 1);
         Left := Left / 16;
      end loop;
      return Found;
   end Written;

   function Name_Of (Line, Key : String) return String is
      Text    : constant UTF_16_Wide_String := Convert (UTF_8_String'(Body_Of (Line, Value_Of (Line, Key))));
      Next    : Positive := Text'First;
      Count   : Natural := 0;
      Code    : Natural;
      Is_Half : Boolean := False;
      Found   : Unbounded_String;

      function Hex return Natural;

      function Hex return Natural is
         Digit : String (1 .. 4);
      begin
         for Place in Digit'Range loop
            Digit (Place) := Character'Val (Wide_Character'Pos (Text (Next + Place - 1)));
            if Digit (Place) not in '0' .. '9' | 'a' .. 'f' | 'A' .. 'F' then
               raise Constraint_Error;
            end if;
         end loop;
         return Natural'Value ("16#" & Digit & "#");
      end Hex;
   begin
      while Next <= Text'Last loop
         Code := Wide_Character'Pos (Text (Next));
         Next := Next + 1;
         if Code = Character'Pos ('\') then
            Code := Wide_Character'Pos (Text (Next));
            Next := Next + 1;
            if Code = Character'Pos ('u') then
               Code := Hex;
               Next := Next + 4;
            elsif Character'Val (Code) not in '"' | '\' | '/' then
               raise Constraint_Error;
            end if;
         end if;
         if Is_Half /= (Code in Low_Half) then
            raise Constraint_Error;
         end if;
         Is_Half := Code in High_Half;
         Count := Count + (if Is_Half then 0 else 1);
         Append (Found, Written (Code));
      end loop;
      if Is_Half or else Count not in 1 .. LIMIT_NAME then
         raise Constraint_Error;
      end if;
      return """" & To_String (Found) & """";
   exception
      when Encoding_Error =>
         raise Constraint_Error;
   end Name_Of;

   function Agrees (Line, Key, Text : String) return Boolean is
      First : constant Natural := Value_In (Line, Key);
   begin
      if First = 0 then
         return True;
      end if;
      declare
         Found : constant String := Body_Of (Line, First);
      begin
         return Found = "" or else """" & Found & """" = Text or else Name_Of (Line, Key) = Text;
      end;
   end Agrees;

end Datagrams;
