--  What the vehicle does when its plan has ended before its end.
with Plans;
with Tables;

package Responses is

   --  Do what an event is answered by, or something plainer where that cannot be done, until nothing is left to
   --  do. A vehicle that holds its place is stayed with. What goes wrong meanwhile is answered too, once.
   procedure Carry_Out (Plan : Plans.Plan; What : Tables.Event; Answer : Tables.Response_To);

end Responses;
