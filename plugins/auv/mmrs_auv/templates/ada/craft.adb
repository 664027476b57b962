with Catalogue; use Catalogue;
with Tables;    use Tables;

package body Craft is

   Depth_Field : Wire.Field := GoalPose_Depth;
   Lost        : Long_Float := LIMIT_POSITION_LOST;

   procedure Sealed (Item : in out Wire.Frame; As : Wire.Message; Counter : in out Unsigned_8);

   function Turned (Degrees : Long_Float) return Long_Float;

   procedure Set_Step (Metres : Long_Float) is
   begin
      Depth_Field.Scale := Metres;
      Depth_Field.Most := Long_Float (Depth_Field.Highest) * Metres;
   end Set_Step;

   procedure Count_As_Lost (Metres : Long_Float) is
   begin
      Lost := Metres;
   end Count_As_Lost;

   function Is_Lost (Known : State) return Boolean is (not Known.Trusted or else Known.Uncertainty > Lost);

   procedure Sealed (Item : in out Wire.Frame; As : Wire.Message; Counter : in out Unsigned_8) is
   begin
      Wire.Seal (Item, As, Counter);
      Counter := Counter + 1;
   end Sealed;

   function Turned (Degrees : Long_Float) return Long_Float is
      Found : constant Long_Float := Long_Float'Remainder (Degrees, 360.0);
   begin
      return (if Found < 0.0 then Found + 360.0 else Found);
   end Turned;

   procedure Goal_Frames (Wanted : Goal; Place_Frame, Pose_Frame : out Wire.Frame) is
   begin
      Place_Frame := Wire.New_Frame (GoalPlace);
      Wire.Put (Place_Frame, GoalPlace_North, Wanted.Where.North);
      Wire.Put (Place_Frame, GoalPlace_East, Wanted.Where.East);
      Pose_Frame := Wire.New_Frame (GoalPose);
      Wire.Put (Pose_Frame, Depth_Field, Wanted.Where.Depth);
      Wire.Put (Pose_Frame, GoalPose_Heading, Turned (Wanted.Heading));
      Wire.Put (Pose_Frame, GoalPose_Speed, Wanted.Speed);
      Wire.Put (Pose_Frame, GoalPose_Mode, Long_Float (Wanted.Mode));
      Wire.Put (Pose_Frame, GoalPose_FaceAlong, (if Wanted.Along then 1.0 else 0.0));
      Wire.Put (Pose_Frame, GoalPose_Goal, Long_Float (Wanted.Number));
   end Goal_Frames;

   protected body Vehicle is

      procedure Begin_Goal (Wanted : Goal) is
         Numbered           : Goal := Wanted;
         First, Second      : Wire.Frame;
      begin
         Numbered.Number := (In_Force.Number + 1) mod LIMIT_GOALS;
         Goal_Frames (Numbered, First, Second);
         In_Force := Numbered;
         Known.Progress := PROGRESS_NONE;
         Known.Distance := 0.0;
      end Begin_Goal;

      procedure Operate (Device, Does : Natural; Parameter : Long_Float) is
         Command : Wire.Frame := Wire.New_Frame (DeviceCommand);
      begin
         Wire.Put (Command, DeviceCommand_Device, Long_Float (Device));
         Wire.Put (Command, DeviceCommand_Action, Long_Float (Does));
         Wire.Put (Command, DeviceCommand_Parameter, Parameter);
         Wire.Put (Command, DeviceCommand_Request, Long_Float ((Known.Asked + 1) mod LIMIT_REQUESTS));
         Known.Asked := (Known.Asked + 1) mod LIMIT_REQUESTS;
         Known.Answer := PROGRESS_NONE;
         Asked := (Command, True);
      end Operate;

      procedure Give_Up (Reason : Natural) is
      begin
         Emergencies := LIMIT_OFTEN;
         Vehicle.Reason := Reason;
         if Known.Emergency = 0 then
            Known.Emergency := Reason;
         end if;
      end Give_Up;

      procedure Hear (Item : Wire.Frame; Now : Long_Float) is
         use Wire;
         Sound : Boolean := True;
      begin
         if Is_Sound (Item, Position) then
            Known.Here.North := Value (Item, Position_North);
            Known.Here.East := Value (Item, Position_East);
         elsif Is_Sound (Item, Depth) then
            Known.Here.Depth := Value (Item, Depth_Depth);
            Known.Uncertainty := Value (Item, Depth_Uncertainty);
            Known.Trusted := Number (Item, Depth_Trusted) = 1;
            Known.Known_At := Now;
         elsif Is_Sound (Item, Pose) then
            Known.Heading := Value (Item, Pose_Heading);
         elsif Is_Sound (Item, Health) then
            Known.Health_At := Now;
            Known.Leak := Number (Item, Health_Leak) = 1;
            Known.Charge := Value (Item, Health_Charge);
            Known.Sonar := Value (Item, Health_SonarRange);
            if Known.Sonar >= LIMIT_FARTHEST_SEEN then
               Known.Sonar := Long_Float'Last;
            end if;
         elsif Is_Sound (Item, Progress) then
            if Number (Item, Progress_Goal) = In_Force.Number then
               Known.Progress := Number (Item, Progress_State);
               Known.Distance := Value (Item, Progress_Distance);
            end if;
         elsif (for some Each of All_Emergencies => Is_Sound (Item, Each)) then
            if Known.Emergency = 0 then
               Known.Emergency := Natural'Max (1, Number (Item, DecisionEmergency_Reason));
            end if;
         elsif Is_Sound (Item, DeviceStatus) then
            if Number (Item, DeviceStatus_Request) = Known.Asked and then Asked.Open then
               Known.Answer := Number (Item, DeviceStatus_State);
               Asked.Open := Known.Answer not in PROGRESS_REACHED | PROGRESS_FAILED;
            end if;
         else
            Sound := False;
         end if;
         if Sound then
            Known.Heard_At := Now;
         end if;
      end Hear;

      procedure Tick (Now : Long_Float; Said : out Frames; Last : out Natural) is
         use Wire;
         Made, Posed : Frame;

         procedure Add (Item : Frame);

         procedure Add (Item : Frame) is
         begin
            Last := Last + 1;
            Said (Last) := Item;
         end Add;
      begin
         Last := 0;
         Began := (if Began = Never then Now else Began);
         Said := (others => (others => <>));
         if Emergencies > 0 then
            Emergencies := Emergencies - 1;
            Made := New_Frame (DecisionEmergency);
            Put (Made, DecisionEmergency_Reason, Long_Float (Reason));
            Put (Made, DecisionEmergency_Release, 1.0);
            Sealed (Made, DecisionEmergency, Counted (1));
            Add (Made);
         end if;
         Goal_Frames (In_Force, Made, Posed);
         Sealed (Made, GoalPlace, Counted (2));
         Add (Made);
         Sealed (Posed, GoalPose, Counted (3));
         Add (Posed);
         Ticks := (Ticks + 1) mod LIMIT_SELDOM;
         if Asked.Open and then (Known.Answer = PROGRESS_NONE or else Ticks = 0) then
            Made := Asked.Command;
            Sealed (Made, DeviceCommand, Counted (4));
            Add (Made);
         end if;
         if Now + 1.0E-6 >= Beat_Due then
            Beat_Due := Now + LIMIT_BEAT_PERIOD;
            Made := New_Frame (DecisionBeat);
            Put (Made, DecisionBeat_State, Long_Float (STATE_RUNS));
            Put (Made, DecisionBeat_Uptime, Long_Float'Min (Now - Began, DecisionBeat_Uptime.Most));
            Put (Made, DecisionBeat_Reason, 0.0);
            Sealed (Made, DecisionBeat, Counted (5));
            Add (Made);
         end if;
      end Tick;

      function Told return State is (Known);

      function Wanted return Goal is (In_Force);

   end Vehicle;

end Craft;
