--  The log of a robot's steps: JSON Lines, as "mmrs replay" reads them.
package Step_Log is

   --  Begin a log; robot and run in JSON.
   procedure Open (Path, Run, Robot : String);

   --  Append a step; move, detail and slots in JSON. It is on the disk when this returns.
   procedure Write (Label, Move, Detail, Slots : String);

   --  Let the next step be later than what another robot has done.
   procedure Come_After (Lamport : Natural);

   function Lamport return Natural;

   --  Seconds by which the run began before this program.
   procedure Shift (Seconds : Long_Float);

   --  A text in JSON.
   function Json (Item : String) return String;

end Step_Log;
