with Ada.Streams;           use Ada.Streams;
with Ada.Streams.Stream_IO;
with Ada.Strings.Fixed;     use Ada.Strings.Fixed;
with Ada.Strings.Unbounded; use Ada.Strings.Unbounded;
with Clocks;
with GNAT.Sockets;          use GNAT.Sockets;
with Guards;
with Tables;                use Tables;

package body Gateway is

   --  Seconds for which an answer is waited for, at first with other robots, and later; between two signs of life.
   Patience : Long_Float := LIMIT_GATHERING + 15.0;
   Later    : constant Long_Float := 5.0;
   Sign     : constant Long_Float := 0.5;

   Link    : Socket_Type;
   Opened  : Boolean := False;
   Pending : Unbounded_String;
   Number  : Natural := 0;
   Told_At : Long_Float := 0.0;
   Allowed : Natural := 0;
   Done    : Boolean := False;

   function Whole (Item : Natural) return String is (Trim (Item'Image, Ada.Strings.Both));
   function Value_After (Line, Key : String; From : Positive) return String;
   function Number_After (Line, Key : String) return Long_Float;
   function Text_After (Line, Key : String) return String;
   function Contents (File : String) return String;
   procedure Receive (Came : out Boolean);
   function Is_News (Line : String) return Boolean;
   function Next_Answer return String;
   procedure Say (Line : String);
   function Asked (Line : String) return String;
   procedure Expect (Line, Answer : String);

   --  What stands after a key, up to the comma or brace that follows; keys of ours are in no text of people.
   function Value_After (Line, Key : String; From : Positive) return String is
      Mark  : constant String := """" & Key & """: ";
      Place : constant Natural := Index (Line, Mark, From);
      First : constant Natural := Place + Mark'Length;
   begin
      if Place = 0 then
         return "";
      end if;
      for Last in First .. Line'Last loop
         if Line (Last) in ',' | '}' then
            return Line (First .. Last - 1);
         end if;
      end loop;
      return "";
   end Value_After;

   function Number_After (Line, Key : String) return Long_Float is
      Found : constant String := Value_After (Line, Key, Line'First);
   begin
      return (if Found = "" then 0.0 else Long_Float'Value (Found));
   end Number_After;

   function Text_After (Line, Key : String) return String is
      Found : constant String := Value_After (Line, Key, Line'First);
   begin
      return (if Found'Length < 2 then "" else Found (Found'First + 1 .. Found'Last - 1));
   end Text_After;

   function Contents (File : String) return String is
      use Ada.Streams.Stream_IO;
      Read : Ada.Streams.Stream_IO.File_Type;
      Data : Stream_Element_Array (1 .. 4096);
      Last : Stream_Element_Offset;
      Text : Unbounded_String;
   begin
      Open (Read, In_File, File);
      Ada.Streams.Stream_IO.Read (Read, Data, Last);
      Close (Read);
      for Each of Data (1 .. Last) loop
         Append (Text, Character'Val (Each));
      end loop;
      return To_String (Text);
   end Contents;

   --  Take what has come; Came: whether anything did, within the socket's patience.
   procedure Receive (Came : out Boolean) is
      Data : Stream_Element_Array (1 .. 4096);
      Last : Stream_Element_Offset;
   begin
      Came := False;
      Receive_Socket (Link, Data, Last);
      if Last < Data'First then
         Opened := False;
         raise Refused with "the gateway has gone";
      end if;
      Came := True;
      for Each of Data (1 .. Last) loop
         Append (Pending, Character'Val (Each));
      end loop;
   exception
      when Error : Socket_Error =>
         if Resolve_Exception (Error) not in Resource_Temporarily_Unavailable | Connection_Timed_Out then
            Opened := False;
            raise Refused with "the gateway is lost";
         end if;
   end Receive;

   --  Take news of a notify; return whether a line is news.
   function Is_News (Line : String) return Boolean is
      What : constant String := Text_After (Line, "is");
   begin
      if What = "granted" then
         Allowed := Natural (Number_After (Line, "lamport"));
      elsif What = "acknowledged" then
         Done := True;
      elsif What = "refused" then
         raise Refused with "a notify is refused: " & Line;
      elsif What /= "changed" and then What /= "waiting" then
         return False;
      end if;
      return True;
   end Is_News;

   --  The next line that is no news; empty: none has come within the socket's patience.
   function Next_Answer return String is
      Came : Boolean;
   begin
      loop
         declare
            Ends : constant Natural := Index (Pending, (1 => ASCII.LF));
         begin
            if Ends > 0 then
               declare
                  Line : constant String := Slice (Pending, 1, Ends - 1);
               begin
                  Delete (Pending, 1, Ends);
                  if not Is_News (Line) then
                     return Line;
                  end if;
               end;
            else
               Receive (Came);
               if not Came then
                  return "";
               end if;
            end if;
         end;
      end loop;
   end Next_Answer;

   procedure Say (Line : String) is
      Data : Stream_Element_Array (1 .. Line'Length + 1);
      Sent : Stream_Element_Offset := 0;
      Last : Stream_Element_Offset;
   begin
      for Index in Line'Range loop
         Data (Stream_Element_Offset (Index - Line'First + 1)) := Character'Pos (Line (Index));
      end loop;
      Data (Data'Last) := Character'Pos (ASCII.LF);
      while Sent < Data'Last loop
         Send_Socket (Link, Data (Sent + 1 .. Data'Last), Last);
         Sent := Last;
      end loop;
      Told_At := Clocks.Passed;
   exception
      when Socket_Error =>
         Opened := False;
         raise Refused with "the gateway is lost";
   end Say;

   function Asked (Line : String) return String is
      Until_Then : constant Long_Float := Clocks.Now + Patience;
   begin
      Say (Line);
      loop
         declare
            Answer : constant String := Next_Answer;
         begin
            if Answer /= "" then
               return Answer;
            end if;
         end;
         Guards.Kick;
         if Clocks.Now > Until_Then then
            raise Refused with "the gateway does not answer";
         end if;
      end loop;
   end Asked;

   procedure Expect (Line, Answer : String) is
      Found : constant String := Asked (Line);
   begin
      if Text_After (Found, "is") /= Answer then
         raise Refused with "the gateway says " & Found;
      end if;
   end Expect;

   procedure Open (File, Robots : String; Offset : out Long_Float) is
      Where   : constant String := Contents (File);
      Address : Sock_Addr_Type;
   begin
      Address.Addr := Loopback_Inet_Addr;
      Address.Port := Port_Type (Number_After (Where, "port"));
      Create_Socket (Link);
      Connect_Socket (Link, Address);
      Set_Socket_Option (Link, IP_Protocol_For_TCP_Level, (No_Delay, True));
      Set_Socket_Option (Link, Socket_Level, (Receive_Timeout, 0.02));
      Expect ("{""do"": ""hello"", ""token"": """ & Text_After (Where, "token") & """}", "welcome");
      declare
         Begun : constant String :=
           Asked ("{""do"": ""begin"", ""robots"": " & Robots & ", ""seconds"": " & Whole (Natural (LIMIT_GATHERING)) & "}");
      begin
         if Text_After (Begun, "is") /= "begun" then
            raise Refused with "the gateway says " & Begun;
         end if;
         Offset := Long_Float'Max (0.0, Number_After (Begun, "late"));
      end;
      Opened := True;
      Patience := Later;
   exception
      when Socket_Error | Ada.Streams.Stream_IO.Name_Error | Ada.Streams.Stream_IO.Use_Error =>
         raise Refused with "no gateway as " & File & " says";
   end Open;

   function Is_Open return Boolean is (Opened);

   procedure Live is
   begin
      if Opened and then Clocks.Passed - Told_At >= Sign then
         Expect ("{""do"": ""alive""}", "alive");
      end if;
   end Live;

   procedure Prepare (Slots : String; Active : Boolean; Finds : String) is
   begin
      Number := Number + 1;
      Allowed := 0;
      Done := False;
      Expect
        ("{""do"": ""prepare"", ""number"": " & Whole (Number) & ", ""slots"": " & Slots & ", ""active"": "
         & (if Active then "true" else "false") & ", ""finds"": " & Finds & "}",
         "asked");
   end Prepare;

   function Granted return Natural is
   begin
      if Next_Answer /= "" then
         raise Refused with "the gateway says what nobody has asked for";
      end if;
      return Allowed;
   end Granted;

   procedure Send (Lamport : Natural) is
   begin
      Expect
        ("{""do"": ""send"", ""number"": " & Whole (Number) & ", ""lamport"": " & Whole (Lamport) & "}", "sent");
   end Send;

   function Is_Set return Boolean is (Granted >= 0 and then Done);

   function Latest return Natural is
      Mark  : constant String := """lamport"": ";
      State : constant String := Asked ("{""do"": ""state""}");
      Place : Natural := Index (State, Mark);
      Found : Natural := 0;
   begin
      while Place > 0 loop
         Found := Natural'Max (Found, Natural'Value (Value_After (State, "lamport", Place)));
         Place := Index (State, Mark, Place + 1);
      end loop;
      return Found;
   end Latest;

   function Passes (Slots : String; Lamport : Natural) return Boolean is
     (Text_After
        (Asked ("{""do"": ""pass"", ""slots"": " & Slots & ", ""lamport"": " & Whole (Lamport) & "}"), "is")
      = "passed");

   function Are_Lost (Robots : String) return Boolean is
     (Index (Asked ("{""do"": ""lost"", ""robots"": " & Robots & "}"), """robots"": " & Robots) > 0);

   function Finds return String is
      Mark : constant String := """finds"": [";
   begin
      if not Opened then
         return "";
      end if;
      declare
         State : constant String := Asked ("{""do"": ""state""}");
         Place : constant Natural := Index (State, Mark);
      begin
         return (if Place = 0 then "" else State (Place + Mark'Length .. State'Last - 2));
      end;
   end Finds;

   procedure Leave is
   begin
      if Opened then
         Expect ("{""do"": ""leave""}", "left");
         Opened := False;
         Close_Socket (Link);
      end if;
   exception
      when Refused | Socket_Error =>
         Opened := False;
   end Leave;

end Gateway;
