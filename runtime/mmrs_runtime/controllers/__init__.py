"""What generated controllers are written in, and run by, whatever drives their vehicles.

`vocabulary` is that of programs, `driver` is what a driver of vehicles supplies, and `running` runs them from
the command line of `options`. Conditions and locators of the user are `user_functions`.
"""

from ..conditions import standard as standard
from ..conditions import undecided as undecided
from .state import State as State
from .user_functions import Condition as Condition
from .user_functions import Locator as Locator
from .user_functions import not_looked_for as not_looked_for
from .user_functions import where_expected as where_expected
from .vocabulary import Geographic as Geographic
from .vocabulary import Local as Local
from .vocabulary import Place as Place
