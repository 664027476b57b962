--  Numbers and names in an object of JSON, as others write it. Whatever is none raises Constraint_Error.
package Datagrams is

   function Number_Of (Line, Key : String; Low, High : Long_Float) return Long_Float;

   --  A name that can be printed, in JSON: all that write the same name are answered by the same text.
   function Name_Of (Line, Key : String) return String;

end Datagrams;
