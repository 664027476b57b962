--  The vehicle as its decision centre sees it: goals and device commands that are repeated, and what it tells.
with Interfaces;            use Interfaces;
with Plans;                 use Plans;
with Wire;

package Craft is

   Never : constant Long_Float := Long_Float'First;

   --  Metres, degrees, metres per second. Charge: part of the battery; negative: not told yet.
   --  Sonar: range ahead. Progress and Distance are of the goal that is in force.
   --  Known_At, Heard_At: when depth was last told, and anything.
   type State is record
      Here               : Place;
      Heading            : Long_Float := 0.0;
      Uncertainty        : Long_Float := Long_Float'Last;
      Trusted            : Boolean := False;
      Charge             : Long_Float := -1.0;
      Sonar              : Long_Float := Long_Float'Last;
      Leak               : Boolean := False;
      Progress           : Natural := 0;
      Distance           : Long_Float := 0.0;
      Emergency          : Natural := 0;
      Asked, Answer      : Natural := 0;
      Known_At, Heard_At : Long_Float := Never;
      Health_At          : Long_Float := Never;
   end record;

   type Frames is array (Positive range <>) of Wire.Frame;

   type Goal is record
      Mode           : Natural := 0;
      Where          : Place;
      Heading, Speed : Long_Float := 0.0;
      Along          : Boolean := False;
      Number         : Natural := 0;
   end record;

   Most_Frames : constant := 5;

   type Counters is array (1 .. 5) of Unsigned_8;

   type Request is record
      Command : Wire.Frame;
      Open    : Boolean := False;
   end record;

   --  How depths are written, metres in a step.
   procedure Set_Step (Metres : Long_Float);

   --  Metres of uncertainty, of one sigma, above which the place counts as lost.
   procedure Count_As_Lost (Metres : Long_Float);

   --  Whether depth, heading or place are not known well enough, as far as was told last.
   function Is_Lost (Known : State) return Boolean;

   procedure Goal_Frames (Wanted : Goal; Place_Frame, Pose_Frame : out Wire.Frame);

   protected Vehicle is

      --  Begin a goal; the number follows the last. Raises Wire.Out_Of_Range.
      procedure Begin_Goal (Wanted : Goal);

      --  Ask a device; State.Asked then is the request's number. Raises Wire.Out_Of_Range.
      procedure Operate (Device, Does : Natural; Parameter : Long_Float);

      --  Have thrust stopped, and the drop weight let go.
      procedure Give_Up (Reason : Natural);

      procedure Hear (Item : Wire.Frame; Now : Long_Float);

      --  Return what is to be sent at the instants at which goals are repeated.
      procedure Tick (Now : Long_Float; Said : out Frames; Last : out Natural);

      function Told return State;

      function Wanted return Goal;

   private
      Known       : State;
      In_Force    : Goal;
      Asked       : Request;
      Counted     : Counters := (others => 0);
      Ticks       : Natural := 0;
      Emergencies : Natural := 0;
      Reason      : Natural := 0;
      Began       : Long_Float := Never;
      Beat_Due    : Long_Float := 0.0;
   end Vehicle;

end Craft;
