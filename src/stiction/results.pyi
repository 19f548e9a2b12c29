from stiction.analysis.report import Analysis as Analysis
from stiction.auditing.report import Audit as Audit
from stiction.checking import Check as Check
from stiction.comparison import Comparison as Comparison
from stiction.inference.next_test.advice import Advice as Advice
from stiction.inference.posterior import Fit as Fit
from stiction.linear_stability.examination import Stability as Stability
from stiction.study.view.mapping import Map as Map
