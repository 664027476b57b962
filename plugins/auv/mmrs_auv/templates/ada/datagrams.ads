--  Numbers and names in an object of JSON, as others write it. Whatever is none raises Constraint_Error.
package Datagrams is

   function Number_Of (Line, Key : String; Low, High : Long_Float) return Long_Float;

   --  A name that can be printed, in JSON: all that write the same name are answered by the same text.
   function Name_Of (Line, Key : String) return String;

   --  Whether a text, in JSON, is that of a key; so it is where the key is missing, or its text is empty.
   function Agrees (Line, Key, Text : String) return Boolean;

end Datagrams;
