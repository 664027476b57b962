with Ada.Containers;
with Ada.Streams;           use Ada.Streams;
with Ada.Strings.Fixed;     use Ada.Strings.Fixed;
with Ada.Strings.Maps;
with Ada.Strings.Unbounded; use Ada.Strings.Unbounded;
with Clocks;
with Datagrams;
with GNAT.Sockets;          use GNAT.Sockets;
with Tables;                use Tables;
with Undecided;

package body Sight is

   Blank : constant Ada.Strings.Maps.Character_Set := Ada.Strings.Maps.To_Set (" " & ASCII.LF & ASCII.CR);

   type Detection is record
      Name, Camera : Unbounded_String;
      Time         : Long_Float;
      Where        : Plans.Place;
      Since        : Long_Float;
   end record;

   package Detections is new Ada.Containers.Vectors (Positive, Detection);
   package Reals is new Ada.Containers.Vectors (Positive, Long_Float);
   package Sorting is new Reals.Generic_Sorting;

   function Median (Of_Numbers : Reals.Vector) return Long_Float;
   function Middle (Found : Detections.Vector) return Plans.Place;
   function Agreeing (Found : Detections.Vector; Where : Plans.Place) return Detections.Vector;

   function Is_Newer (Earlier, Item : Detection) return Boolean;

   protected Memory is
      procedure Keep (Item : Detection);
      procedure Find (Name : Unbounded_String; Now : Long_Float; Seen : out Boolean; Where : out Plans.Place);
      function Seen_So_Far return Thing_Lists.Vector;
   private
      Latest : Detections.Vector;
      Things : Thing_Lists.Vector;
   end Memory;

   task Listener is
      entry Go;
   end Listener;

   Link      : Socket_Type;
   Owner     : Unbounded_String;
   Listening : Boolean := False;
   pragma Atomic (Listening);

   function Name_In (Line, Key : String) return Unbounded_String is
     (To_Unbounded_String (Datagrams.Name_Of (Line, Key)));

   function Camera_In (Line : String) return Unbounded_String is
     (if Datagrams.Name_Of (Line, "camera") in """front""" | """bottom""" then Name_In (Line, "camera")
      else raise Constraint_Error);

   function Median (Of_Numbers : Reals.Vector) return Long_Float is
      Sorted : Reals.Vector := Of_Numbers;
      Half   : constant Natural := Natural (Sorted.Length) / 2;
   begin
      Sorting.Sort (Sorted);
      return
        (if Natural (Sorted.Length) mod 2 = 1 then Sorted (Half + 1) else (Sorted (Half) + Sorted (Half + 1)) / 2.0);
   end Median;

   function Middle (Found : Detections.Vector) return Plans.Place is
      North, East, Depth : Reals.Vector;
   begin
      for Each of Found loop
         North.Append (Each.Where.North);
         East.Append (Each.Where.East);
         Depth.Append (Each.Where.Depth);
      end loop;
      return (Median (North), Median (East), Median (Depth));
   end Middle;

   function Agreeing (Found : Detections.Vector; Where : Plans.Place) return Detections.Vector is
      Near : Detections.Vector;
   begin
      for Each of Found loop
         if Plans.Away (Each.Where, Where) <= LIMIT_DETECTION_SPREAD then
            Near.Append (Each);
         end if;
      end loop;
      return Near;
   end Agreeing;

   --  Whether what was kept earlier is of a later time, by the same clock.
   function Is_Newer (Earlier, Item : Detection) return Boolean is
     (Earlier.Time > Item.Time
      and then (Earlier.Time - Item.Time < LIMIT_DETECTION_REPEATED or else Item.Since - Earlier.Since <= LIMIT_DETECTION_LASTS));

   protected body Memory is
      procedure Keep (Item : Detection) is
         Oldest, Of_Name  : Natural := 0;
         Of_Camera, Newer : Natural := 0;
         Is_Seen          : Boolean;
         Where            : Plans.Place;
      begin
         for Index in 1 .. Natural (Latest.Length) loop
            if Latest (Index).Name = Item.Name then
               Oldest := (if Oldest = 0 then Index else Oldest);
               Of_Name := Of_Name + 1;
               if Latest (Index).Camera = Item.Camera then
                  if Latest (Index).Time = Item.Time then
                     return;
                  end if;
                  Of_Camera := Of_Camera + 1;
                  if Is_Newer (Latest (Index), Item) then
                     Newer := Newer + 1;
                  end if;
               end if;
            end if;
         end loop;
         if Newer > Natural'Max (1, Of_Camera / 2) then
            return;
         end if;
         if Of_Name = LIMIT_DETECTIONS_KEPT then
            Latest.Delete (Oldest);
         elsif Natural (Latest.Length) = LIMIT_OBJECTS * LIMIT_DETECTIONS_KEPT then
            Latest.Delete_First;
         end if;
         Latest.Append (Item);
         Find (Item.Name, Item.Since, Is_Seen, Where);
         if not Is_Seen then
            return;
         end if;
         for Each of Things loop
            if Each.Name = Item.Name then
               Each.Where := Where;
               return;
            end if;
         end loop;
         if Natural (Things.Length) < LIMIT_OBJECTS then
            Things.Append ((Item.Name, Where));
         end if;
      end Keep;

      procedure Find (Name : Unbounded_String; Now : Long_Float; Seen : out Boolean; Where : out Plans.Place) is
         Found, Near : Detections.Vector;
      begin
         Where := (others => <>);
         for Each of Latest loop
            if Each.Name = Name and then Now - Each.Since <= LIMIT_DETECTION_LASTS then
               Found.Append (Each);
            end if;
         end loop;
         loop
            Seen := Natural (Found.Length) >= LIMIT_DETECTIONS_AGREE;
            exit when not Seen;
            Where := Middle (Found);
            Near := Agreeing (Found, Where);
            exit when Natural (Near.Length) = Natural (Found.Length);
            Found := Near;
         end loop;
      end Find;

      function Seen_So_Far return Thing_Lists.Vector is (Things);
   end Memory;

   procedure Take (Line : String; Now : Long_Float) is
      Text : constant String := Trim (Line, Blank, Blank);
   begin
      if Text = "" or else Text (Text'Last) /= '}' then
         return;
      elsif Length (Owner) > 0 and then not Datagrams.Agrees (Line, "robot", To_String (Owner)) then
         return;
      elsif Datagrams.Number_Of (Line, "confidence", 0.0, 1.0) >= LIMIT_CONFIDENCE then
         Memory.Keep
           ((Name   => Name_In (Line, "name"),
             Camera => Camera_In (Line),
             Time   => Datagrams.Number_Of (Line, "time", 0.0, LIMIT_DETECTION_LATEST),
             Where  =>
               (North => Datagrams.Number_Of (Line, "north", -LIMIT_DETECTION_FARTHEST, LIMIT_DETECTION_FARTHEST),
                East  => Datagrams.Number_Of (Line, "east", -LIMIT_DETECTION_FARTHEST, LIMIT_DETECTION_FARTHEST),
                Depth => Datagrams.Number_Of (Line, "depth", -LIMIT_DETECTION_FARTHEST, LIMIT_DETECTION_DEEPEST)),
             Since  => Now));
      end if;
   exception
      when Constraint_Error =>
         null;
   end Take;

   procedure Belong_To (Robot : String) is
   begin
      Owner := To_Unbounded_String (Robot);
   end Belong_To;

   procedure Open (Port : Natural) is
   begin
      Create_Socket (Link, Family_Inet, Socket_Datagram);
      Bind_Socket (Link, (Family_Inet, Loopback_Inet_Addr, Port_Type (Port)));
      Listening := True;
      Listener.Go;
   end Open;

   function Is_Open return Boolean is (Listening);

   procedure Look_For (Name : String; Now : Long_Float; Seen : out Boolean; Where : out Plans.Place) is
   begin
      Memory.Find (To_Unbounded_String (Name), Now, Seen, Where);
   end Look_For;

   function Known_Things (Most : Positive) return Thing_Lists.Vector is
      Found : Thing_Lists.Vector := Memory.Seen_So_Far;
   begin
      Found.Set_Length (Ada.Containers.Count_Type'Min (Found.Length, Ada.Containers.Count_Type (Most)));
      return Found;
   end Known_Things;

   function Is_Known (Name : String) return Boolean is
     (for some Each of Memory.Seen_So_Far => Each.Name = Name);

   function Has_Seen (Name : String) return Boolean is
   begin
      if not Listening then
         raise Undecided.Not_Decided with "nobody listens to detections: --detections PORT";
      end if;
      return Is_Known (Name);
   end Has_Seen;

   task body Listener is
      Data : Stream_Element_Array (1 .. LIMIT_DATAGRAM);
      Last : Stream_Element_Offset;
      Line : String (1 .. LIMIT_DATAGRAM);
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
