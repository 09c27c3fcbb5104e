"""All numbers that steer a diagnosis, in one record that `diagnosis.json` holds."""

from dataclasses import dataclass, field

from pyrofit.estimate.bounded_least_squares import (
    FIRST_RADIUS,
    LIKE_PARABOLA,
    MOST_STEPS,
    NEAR,
    RIDGE,
)
from pyrofit.estimate.posterior import AT_LIMIT


@dataclass(frozen=True)
class Settings:
    """Numbers of the fits, the search, the tests of a claim, and the advice.

    Chi-square counts misfit in units of the noise. x is a fraction of the search range. Numbers
    that every fit shares are stated, but cannot be handed in: ``returning_chi2``,
    ``returning_share`` and ``at_limit``.
    """

    # Least squares
    most_steps: int = MOST_STEPS
    """Steps of a descent at most."""
    first_radius: float = FIRST_RADIUS
    """Length of the first step at most, in search ranges."""
    converged_gain: float = 0.01
    """A descent ends where the next step promises less of chi-square."""
    ridge: float = RIDGE
    """Added to the curvature, so that a parameter without influence does not move."""
    returning_chi2: float = field(default=NEAR, init=False)
    """Largest rise of chi-square above a known fit from which a descent may return to it."""
    returning_share: float = field(default=LIKE_PARABOLA, init=False)
    """Largest relative difference of this rise from that of the parabola about the fit."""
    rough_gain: float = 1.0
    """A rough descent ends where fresh derivatives promise less of chi-square."""
    same_valley: float = 0.5
    """Two descents that end within this chi-square have found the same minimum."""
    at_limit: float = field(default=AT_LIMIT, init=False)
    """A parameter rests at a limit if x is within this distance of it."""

    # Base model
    base_starts: int = 15
    """Points within the limits at which chi-square is evaluated, beside their centre."""
    base_descents: int = 8
    """Descents, from the best of these points."""
    most_work: int = 5
    """Largest multiple of the cells and time steps of the fitted base model that a run gets."""
    most_solver_error: float = 1.0
    """Runs are as fine as the study asks for if coarser ones change more of chi-square."""
    most_solver_share: float = 0.02
    """The same as a share of the standard deviation of chi-square, of studies of many points."""
    most_of_kinetics: int = 2
    """Effects that the fit to small samples alone may add."""
    kinetics_reach: float = 3.0
    """Standard deviations of that fit within which all signals may move the kinetics."""
    narrowest_kinetics: float = 0.01
    """Least distance in x of these limits from that fit."""
    wide_sd: float = 0.1
    """A parameter whose standard deviation in x is larger is hardly determined."""
    elsewhere: tuple[float, ...] = (0.15, 0.5, 0.85)
    """Values in x from which such a parameter is searched again."""
    apart: float = 0.2
    """A value nearer than this to the fitted one is no new start."""
    most_polishing_rounds: int = 3
    """Rounds of such searches at most, as long as they lower chi-square."""

    # Adequacy
    false_alarm_level: float = 0.01
    """Probability of a false alarm, for each of the scan, the scores, and chi-square."""
    lasting_level: float = 1e-3
    """Probability that noise makes a signal's misfit weigh known values."""
    draw_blocks: int = 10
    """Blocks of noise draws, each with its own random generator."""
    draws_per_block: int = 100
    """Draws of a block."""
    close_scan: float = 0.15
    """The critical value is drawn again, from more blocks, if the scan is nearer to it."""
    close_draw_blocks: int = 60
    """Blocks of that second draw."""
    most_windows: int = 8
    """Windows of misfit of one signal at most."""

    # Search
    tried_strengths: tuple[float, ...] = (0.1, 0.3, 1.0, 3.0)
    """Tried strengths as fractions of the typical distance from the null value, on both sides."""
    near_limit: float = 0.02
    """Tried strengths keep this fraction of the search range to either limit."""
    most_formed: int = 5
    """Effects whose form parameters are tried after the first step."""
    hopeless_chi2: float = 50.0
    """A fit that ends this far above the best one is not refined."""
    hopeless_gain: float = 3.0
    """A fit that lowers chi-square by less is not refined. A claim needs log(points) at least."""
    little_gain_share: float = 0.005
    """An effect that lowers chi-square by a smaller share is fitted from a second start."""
    weak_share: float = 0.3
    """An effect that ends within this share of the typical distance from its null value is fitted
    from a second start as well."""
    most_polished: int = 5
    """Models of a step that are searched again from other values of uncertain parameters."""
    most_form_parameters: int = 2
    """Form parameters of a model that are freed one after the other."""
    most_polished_forms: int = 2
    """Models with a freed form parameter that are searched again in the same way."""
    most_restarts: int = 3
    """Models of a step from which the model without their last effect is fitted again."""
    most_refitted: int = 5
    """Effects that are fitted again where that lowered chi-square."""
    most_carried: int = 3
    """Models of each number of effects that a search with a sharper noise starts from."""
    most_predicted: int = 6
    """Models of a step whose predictions are compared."""
    most_exchanged: int = 3
    """Other effects that are tried in the place of each effect of the final model: those that
    promise most. All others of its group are tried as well."""
    most_split: int = 5
    """Effects beside which a second one is tried, in the place of an effect with free forms."""
    most_beside: int = 2
    """Second effects that are tried beside each of them."""
    other_starts: int = 2
    """Other ends of the base's fits, or points of its limits, from which leading effects are fitted
    as well, if misfit is left."""
    noise_leaders: int = 3
    """Effects with which the noise is estimated again."""
    ambiguous_chi2: float = 9.0
    """Models within this penalised chi-square of the best one cannot be told apart."""
    free_effects: int = 2
    """Effects that need not gain beside the misfit that is left."""
    branches: int = 2
    """Models that a step carries on."""
    far_chi2_ratio: float = 10.0
    """A model is not carried on if its chi-square exceeds the best one's by this factor."""
    candidates_of_first_branch: int = 14
    """Effects that are added to the best model of a step, from the second effect on."""
    candidates_of_second_branch: int = 6
    """Effects that are added to the second best model of a step."""
    clearer_bic: float = 6.0
    """Gain in BIC that a new estimate of the noise must bring to be used."""
    weighings: int = 2
    """How often known values are weighed by a misfit that they change."""
    lighter_known: float = 0.8
    """Ratio of weights of known values below which a search with the lower one is made."""
    disturbance: float = 0.1
    """Part of the noise by which measured values are changed to test the stability of a result."""
    misfit_chi2_per_point: float = 2.0
    """Above this chi-square per point of a signal, its misfit was not mistaken for noise."""

    # Tests of a claim
    misfit_beside_claim: float = 3.0
    """Beside a larger misfit of a signal, rms over its noise, no effect is claimed."""
    agreement_level: float = 1e-3
    """Strengths of different experiments disagree if chance is less probable than this."""
    firm_agreement: float = 0.05
    """The same for a claim beside misfit that is left."""
    informative_gain: float = 2.0
    """Smallest difference of log scores that counts: odds of 7 to 1."""
    deciding_gain: float = 5.4
    """Least expected gain of a prediction that alone can reject an effect: it then errs in at most
    5 %, for a gain of N(G, 2 G) with a real effect, and of N(-G, 2 G) without one."""
    claimed_weight: float = 0.95
    """Share of the weight of all fitted models that has an effect of a claimed group."""
    far_from_known: float = 2.0
    """Standard deviations from a known value that count as far away."""
    moved_from_known: float = 0.5
    """Standard deviations by which an effect must move a parameter for its accord to be tested."""
    widest_known: float = 10.0
    """Stated standard deviations within which a known value is searched that may be wrong."""
    held_known: float = 10.0
    """Divisor of the standard deviations of known values that are held."""
    most_suspects: int = 3
    """Candidates that are named for the misfit that a verdict leaves unexplained."""
    certain_evidence: float = 20.0
    """Largest rise of -2 ln Z at which a free correction counts as explaining the data nearly as
    well: the odds are then 22,000 to 1."""
    most_judged: int = 6
    """Models that are judged in the place of one effect, at most."""

    # Parameters of an effect that the data determine
    open_sd: float = 0.15
    """A parameter with a larger relative standard deviation is left open by the data."""
    ridge_gain: float = 3.0
    """A product of such parameters is stated if it is known this many times better."""

    # Free corrections
    correction_coefficients: int = 6
    """Coefficients of a curve over time or temperature."""
    correction_flux_sd: float = 0.15
    """Prior standard deviation of the relative change of the flux."""
    correction_property_sd: float = 0.2
    """Prior standard deviation of a property's change, relative to its median over temperature."""
    correction_points_drawn: int = 60
    """Points of a correction over temperature that are recorded."""
    widest_correction: float = 3.0
    """Limits of a coefficient, in standard deviations of its prior."""
    correction_price: float = 2.0
    """Penalty per coefficient in the order of corrections (Akaike 1974,
    doi 10.1109/TAC.1974.1100705)."""
    burnt_share: float = 0.9
    """Share of the lost mass after which the front's temperature does not count."""

    # Next experiment
    design_fewest_times: int = 20
    """Points of a signal at least."""
    design_longest_s: float = 3600.0
    """Longest record."""
    design_burnt_out: float = 0.995
    """Share of the lost mass at which a record ends, but for a tenth of its length."""
    design_spacing_s: float = 5.0
    """Spacing of the points of a signal that the study does not measure."""
