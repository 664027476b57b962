--  What one robot does.
with Plans; use Plans;

package Mission is

   procedure Build (Into : in out Plan);

end Mission;
