--  Goes through a robot's moves: the states of a mission, composed to tasks.
with Plans;

package Machine is

   --  Return whether the robot came to its end; False: it failed, and came up.
   function Runs (Plan : Plans.Plan) return Boolean;

end Machine;
