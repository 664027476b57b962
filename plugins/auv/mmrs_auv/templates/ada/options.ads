--  What the command line says.
package Options is

   --  Its message is for people.
   Wrong : exception;

   Usage : constant String :=
     "decision_centre --bus HOST:PORT [--channel can0] [--logs FOLDER] [--run ID] [--patience SECONDS] "
     & "[--depth-step METRES] [--gateway FILE] [--detections PORT] [--clearance METRES] [--position-lost METRES]";

   --  Raise Wrong where there are options of other names.
   procedure Refuse_Others;

   function Text (Name, Otherwise : String) return String;

   --  Raises Wrong where it is no number, or none from 0 to Most.
   function Number (Name : String; Otherwise, Most : Long_Float) return Long_Float;

   function Host return String;

   --  Both raise Wrong where there is none.
   function Port return Positive;

end Options;
