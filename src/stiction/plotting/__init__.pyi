from stiction.plotting.analysis.creep_curve import plot_creep as plot_creep
from stiction.plotting.analysis.cycles import plot_cycles as plot_cycles
from stiction.plotting.analysis.energy import plot_energy as plot_energy
from stiction.plotting.analysis.oscillation import plot_oscillation as plot_oscillation
from stiction.plotting.analysis.overview import plot_analysis as plot_analysis
from stiction.plotting.analysis.spectrogram import plot_spectrogram as plot_spectrogram
from stiction.plotting.analysis.tolerance import plot_tolerance as plot_tolerance
from stiction.plotting.analysis.trials import plot_trials as plot_trials
from stiction.plotting.apparatus.schematic import plot_slider as plot_slider
from stiction.plotting.inference.posterior import plot_corner as plot_corner
from stiction.plotting.inference.posterior import plot_posterior as plot_posterior
from stiction.plotting.inference.predictive import plot_predictive as plot_predictive
from stiction.plotting.inference.predictive import plot_ranks as plot_ranks
from stiction.plotting.protocols.healing import plot_healing as plot_healing
from stiction.plotting.protocols.hysteresis import plot_hysteresis as plot_hysteresis
from stiction.plotting.protocols.load_dependence import (
    plot_load_dependence as plot_load_dependence,
)
from stiction.plotting.protocols.velocity_steps import plot_velocity_steps as plot_velocity_steps
from stiction.plotting.protocols.yaw import plot_apparent_friction as plot_apparent_friction
from stiction.plotting.run.comparison import plot_comparison as plot_comparison
from stiction.plotting.run.glance import plot_glance as plot_glance
from stiction.plotting.run.law import plot_law as plot_law
from stiction.plotting.run.overview import plot_run as plot_run
from stiction.plotting.stability.boundary import plot_boundary as plot_boundary
from stiction.plotting.stability.damping import plot_damping as plot_damping
from stiction.plotting.stability.examination import plot_stability as plot_stability
from stiction.plotting.stability.modes import plot_modes as plot_modes
from stiction.plotting.stability.onset import plot_onset as plot_onset
from stiction.study.view.mapping import plot_map as plot_map
