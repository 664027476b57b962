with Ada.Containers.Vectors;
with Ada.Streams;           use Ada.Streams;
with Ada.Strings.Fixed;     use Ada.Strings.Fixed;
with Ada.Strings.Unbounded; use Ada.Strings.Unbounded;
with Clocks;
with GNAT.Sockets;          use GNAT.Sockets;
with Undecided;

package body Sight is

   Confidence : constant Long_Float := 0.5;
   Lasting    : constant Long_Float := 10.0;
   Spread     : constant Long_Float := 1.0;
   Most       : constant := 64;
   Longest    : constant := 1024;

   type Detection is record
      Name               : Unbounded_String;
      North, East, Depth : Long_Float;
      Since              : Long_Float;
   end record;

   package Detections is new Ada.Containers.Vectors (Positive, Detection);
   package Names is new Ada.Containers.Vectors (Positive, Unbounded_String);

   protected Memory is
      procedure Keep (Item : Detection);
      function Knows (Name : Unbounded_String) return Boolean;
   private
      Latest : Detections.Vector;
      Seen   : Names.Vector;
   end Memory;

   task Listener is
      entry Go;
   end Listener;

   Link      : Socket_Type;
   Listening : Boolean := False;
   pragma Atomic (Listening);

   function Agrees (Left, Right : Detection) return Boolean;
   function Number_After (Line, Key : String) return Long_Float;
   function Name_In (Line : String) return String;

   function Agrees (Left, Right : Detection) return Boolean is
     (Left.Name = Right.Name
      and then abs (Left.Since - Right.Since) <= Lasting
      and then abs (Left.North - Right.North) <= Spread
      and then abs (Left.East - Right.East) <= Spread
      and then abs (Left.Depth - Right.Depth) <= Spread);

   protected body Memory is
      procedure Keep (Item : Detection) is
      begin
         if (for some Each of Latest => Agrees (Each, Item)) and then not Seen.Contains (Item.Name) then
            Seen.Append (Item.Name);
         end if;
         if Natural (Latest.Length) >= Most then
            Latest.Delete_First;
         end if;
         Latest.Append (Item);
      end Keep;

      function Knows (Name : Unbounded_String) return Boolean is (Seen.Contains (Name));
   end Memory;

   function Number_After (Line, Key : String) return Long_Float is
      Mark  : constant String := """" & Key & """: ";
      Place : constant Natural := Index (Line, Mark);
      First : constant Natural := Place + Mark'Length;
   begin
      for Last in First .. Line'Last loop
         if Place > 0 and then Line (Last) in ',' | '}' then
            return Long_Float'Value (Line (First .. Last - 1));
         end if;
      end loop;
      raise Constraint_Error with "no " & Key;
   end Number_After;

   function Name_In (Line : String) return String is
      Mark  : constant String := """name"": """;
      Place : constant Natural := Index (Line, Mark);
      First : constant Natural := Place + Mark'Length;
      Last  : Natural := First;
   begin
      while Place > 0 and then Last <= Line'Last loop
         if Line (Last) = '"' then
            return Line (First - 1 .. Last);
         end if;
         Last := Last + (if Line (Last) = '\' then 2 else 1);
      end loop;
      raise Constraint_Error with "no name";
   end Name_In;

   procedure Take (Line : String; Now : Long_Float) is
   begin
      if Number_After (Line, "confidence") >= Confidence then
         Memory.Keep
           ((Name  => To_Unbounded_String (Name_In (Line)),
             North => Number_After (Line, "north"),
             East  => Number_After (Line, "east"),
             Depth => Number_After (Line, "depth"),
             Since => Now));
      end if;
   exception
      when Constraint_Error =>
         null;
   end Take;

   procedure Open (Port : Natural) is
   begin
      Create_Socket (Link, Family_Inet, Socket_Datagram);
      Bind_Socket (Link, (Family_Inet, Loopback_Inet_Addr, Port_Type (Port)));
      Listening := True;
      Listener.Go;
   end Open;

   function Has_Seen (Name : String) return Boolean is
   begin
      if not Listening then
         raise Undecided.Not_Decided with "nobody listens to detections: --detections PORT";
      end if;
      return Memory.Knows (To_Unbounded_String (Name));
   end Has_Seen;

   task body Listener is
      Data : Stream_Element_Array (1 .. Longest);
      Last : Stream_Element_Offset;
      Line : String (1 .. Longest);
   begin
      select
         accept Go;
      or
         terminate;
      end select;
      loop
         Receive_Socket (Link, Data, Last);
         for Index in 1 .. Last loop
            Line (Integer (Index)) := Character'Val (Data (Index));
         end loop;
         Take (Line (1 .. Integer (Last)), Clocks.Now);
      end loop;
   exception
      when Socket_Error =>
         Listening := False;
   end Listener;

end Sight;
