--  The slots of all robots, as "mmrs bus gateway" passes them on: lines of JSON over TCP. One task speaks here.
package Gateway is

   Refused : exception;

   --  Connect by the file in which the gateway says where it listens, and begin together with all robots.
   --  Offset: seconds that the run has lasted. Raises Refused.
   procedure Open (File, Robots : String; Offset : out Long_Float);

   function Is_Open return Boolean;

   --  Say now and then that this program lives, and hear what is new. Raises Refused.
   procedure Live;

   --  Ask that slots are set, and tell what was detected, lists in JSON; Granted: the logical time from which on
   --  that may be, 0 while it is not yet known.
   procedure Prepare (Slots : String; Active : Boolean; Finds : String);
   function Granted return Natural;

   --  Set them, once that is in the log with its logical time; Is_Set: whether all owners know.
   procedure Send (Lamport : Natural);
   function Is_Set return Boolean;

   --  The greatest logical time of any own slot.
   function Latest return Natural;

   --  Pass own slots, a list in JSON, at a logical time; return whether all are active.
   function Passes (Slots : String; Lamport : Natural) return Boolean;

   --  Whether all of these robots, a list in JSON, have ended or are out of reach.
   function Are_Lost (Robots : String) return Boolean;

   --  What robots that have notified this one had detected: the items of a list in JSON; empty: nothing.
   function Finds return String;

   --  Need no slots any more, and set none; raises nothing.
   procedure Leave;

end Gateway;
