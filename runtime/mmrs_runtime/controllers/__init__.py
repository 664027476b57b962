"""What generated controllers are written in, and run by, whatever drives their vehicles.

`words` are those of programs, `driver` is what a driver of vehicles supplies, and `running` runs them from
the command line of `options`. What only the user can say, by functions, are `judgement` and `objects`.
"""

from ..conditions import standard as standard
from ..conditions import undecided as undecided
from .judgement import Condition as Condition
from .objects import Locator as Locator
from .objects import not_looked_for as not_looked_for
from .objects import where_expected as where_expected
from .state import State as State
from .words import Geographic as Geographic
from .words import Local as Local
from .words import Place as Place
