--  The log of a robot's steps: JSON Lines, as "mmrs replay" reads them.
package Step_Log is

   --  A step could not be kept.
   Unwritten : exception;

   --  Begin a log; robot and run in JSON. Raises Unwritten.
   procedure Open (Path, Run, Robot : String);

   --  Append a step; move, detail and slots in JSON. It is on the disk when this returns. Raises Unwritten.
   procedure Write (Label, Move, Detail, Slots : String);

   --  Let the next step be later than what another robot has done.
   procedure Come_After (Lamport : Natural);

   function Lamport return Natural;

   --  Seconds by which the run began before this program.
   procedure Shift (Seconds : Long_Float);

   --  A number in JSON, with six digits after the point.
   function Image (Item : Long_Float) return String;

   --  A text in JSON.
   function Json (Item : String) return String;

end Step_Log;
