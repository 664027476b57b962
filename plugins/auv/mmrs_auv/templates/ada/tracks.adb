with Ada.Strings.Unbounded; use Ada.Strings.Unbounded;
with Plans;                 use Plans;
with Tables;                use Tables;

package body Tracks is

   package Number_Lists is new Ada.Containers.Vectors (Positive, Positive);

   Places : Place_Lists.Vector;
   Moves  : Number_Lists.Vector;

   function Beside (Here, From, To : Place) return Long_Float;
   function Is_Above (Left, Right : Place) return Boolean;
   function Length (Here : Place; Along : Place_Lists.Vector) return Long_Float;
   function Joined (Here : Place) return Positive;
   function Behind (Here : Place) return Place_Lists.Vector;
   function Ahead (Plan : Plans.Plan) return Place_Lists.Vector;
   function Straight (Here : Place; Along : Place_Lists.Vector) return Place_Lists.Vector;

   procedure Pass (Move : Positive; Where : Place) is
   begin
      Places.Append ((Where.North, Where.East, Long_Float'Max (0.0, Where.Depth)));
      Moves.Append (Move);
   end Pass;

   function Is_Empty return Boolean is (Places.Is_Empty);

   function Latest return Place is (Places.Last_Element);

   procedure Forget is
   begin
      Places.Clear;
      Moves.Clear;
   end Forget;

   --  Metres from a place to a straight leg.
   function Beside (Here, From, To : Place) return Long_Float is
      Leg    : constant Place := (To.North - From.North, To.East - From.East, To.Depth - From.Depth);
      Along  : constant Place := (Here.North - From.North, Here.East - From.East, Here.Depth - From.Depth);
      Square : constant Long_Float := Leg.North ** 2 + Leg.East ** 2 + Leg.Depth ** 2;
      Part   : Long_Float := 0.0;
   begin
      if Square > 0.0 then
         Part := (Along.North * Leg.North + Along.East * Leg.East + Along.Depth * Leg.Depth) / Square;
         Part := Long_Float'Min (1.0, Long_Float'Max (0.0, Part));
      end if;
      return Away
        (Here, (From.North + Part * Leg.North, From.East + Part * Leg.East, From.Depth + Part * Leg.Depth));
   end Beside;

   function Is_Above (Left, Right : Place) return Boolean is
     (Away ((Left.North, Left.East, 0.0), (Right.North, Right.East, 0.0)) <= LIMIT_NEAR);

   function Length (Here : Place; Along : Place_Lists.Vector) return Long_Float is
      From  : Place := Here;
      Whole : Long_Float := 0.0;
   begin
      for Each of Along loop
         Whole := Whole + Away (From, Each);
         From := Each;
      end loop;
      return Whole;
   end Length;

   --  The number of the place that begins the first leg on which the vehicle is.
   function Joined (Here : Place) return Positive is
   begin
      for Index in 1 .. Places.Last_Index - 1 loop
         if Beside (Here, Places (Index), Places (Index + 1)) <= LIMIT_NEAR then
            return Index;
         end if;
      end loop;
      return Places.Last_Index;
   end Joined;

   function Behind (Here : Place) return Place_Lists.Vector is
      Index : Natural := Joined (Here);
      Found : Place_Lists.Vector;
   begin
      while Index > 0 loop
         Found.Append (Places (Index));
         for Earlier in 1 .. Index loop
            if Away (Places (Earlier), Places (Index)) <= LIMIT_NEAR then
               Index := Earlier - 1;
               exit;
            end if;
         end loop;
      end loop;
      return Found;
   end Behind;

   --  The rest of the plan's way to where it began; empty where it leads elsewhere.
   function Ahead (Plan : Plans.Plan) return Place_Lists.Vector is
      Number : Positive := Moves.Last_Element;
      Found  : Place_Lists.Vector;

      procedure Follow (Along : Move);

      procedure Follow (Along : Move) is
         From : constant Place := (if Found.Is_Empty then Places.Last_Element else Found.Last_Element);
      begin
         Found.Append (Short_Of (From, Along.Target, Along.Away));
      end Follow;
   begin
      if Plan.Moves (Number).Kind = Goes
        and then Plan.Moves (Number).Object = ""
        and then Away (Plan.Moves (Number).Target, Places.Last_Element) > LIMIT_NEAR + Plan.Moves (Number).Away
      then
         Follow (Plan.Moves (Number));
      end if;
      for Count in 1 .. Plan.Moves.Last_Index loop
         exit when Plan.Moves (Number).Way /= Takes;
         Number := Plan.Moves (Number).To;
         case Plan.Moves (Number).Kind is
            when Goes =>
               exit when Plan.Moves (Number).Object /= "";
               Follow (Plan.Moves (Number));

            when Stops =>
               if not Found.Is_Empty and then Is_Above (Found.Last_Element, Places.First_Element) then
                  return Found;
               end if;
               exit;

            when Starts | Charges =>
               exit;

            when Holds | Turns =>
               null;
         end case;
      end loop;
      return Place_Lists.Empty_Vector;
   end Ahead;

   --  The places without those on the straight line between others.
   function Straight (Here : Place; Along : Place_Lists.Vector) return Place_Lists.Vector is
      Corner        : Place := Here;
      Passed, Found : Place_Lists.Vector;
   begin
      for Index in 1 .. Along.Last_Index - 1 loop
         Passed.Append (Along (Index));
         if (for some Each of Passed => Beside (Each, Corner, Along (Index + 1)) > LIMIT_ALIGNED) then
            Corner := Along (Index);
            Passed.Clear;
            Found.Append (Corner);
         end if;
      end loop;
      if not Along.Is_Empty then
         Found.Append (Along.Last_Element);
      end if;
      return Found;
   end Straight;

   function Way_Back (Plan : Plans.Plan; Here : Place) return Place_Lists.Vector is
      Back, Onwards : Place_Lists.Vector;
   begin
      if Places.Is_Empty or else Is_Above (Here, Places.First_Element) then
         return Place_Lists.Empty_Vector;
      end if;
      Back := Behind (Here);
      Onwards := Ahead (Plan);
      if not Onwards.Is_Empty and then Length (Here, Onwards) < Length (Here, Back) then
         Back := Onwards;
      end if;
      return Straight (Here, Back);
   end Way_Back;

end Tracks;
