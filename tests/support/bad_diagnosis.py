"""Diagnoses and effects of the truth that are refused before anything is read."""

from bad_input import CHECK, SYNTHETIC, Break, put, rows_of

BACK = {"slab_25": ["back_temperature"]}


def truth(**effects: object) -> Break:
    """Compute a signal from a truth with effects."""
    return put(
        experiments__slab_25__signals__mlr={"file": "synthetic"},
        synthetic={**SYNTHETIC, "effects": effects},
    )


DIAGNOSIS = rows_of(
    CHECK,
    ("error: study.yaml: ",),
    [
        (
            "unknown key of the diagnosis",
            put(diagnosis={"calibrat": BACK}),
            ("diagnosis: unknown key 'calibrat'. Did you mean 'calibrate'?",),
        ),
        (
            "unknown experiment to calibrate",
            put(diagnosis={"calibrate": {"slab_2": ["mlr"]}}),
            ("diagnosis.calibrate: unknown experiment 'slab_2'. Did you mean 'slab_25'?",),
        ),
        (
            "unknown signal to calibrate",
            put(diagnosis={"calibrate": {"slab_50": ["back_temperature"]}}),
            ("experiment 'slab_50' has no signal 'back_temperature'. Known: mlr.",),
        ),
        (
            "signal calibrated twice",
            put(diagnosis={"calibrate": {"slab_25": ["mlr", "mlr"]}}),
            ("diagnosis.calibrate.slab_25: a signal stands twice",),
        ),
        (
            "experiment to calibrate without signals",
            put(diagnosis={"calibrate": {"slab_25": []}}),
            ("diagnosis.calibrate.slab_25: name at least one signal, or leave it out",),
        ),
        (
            "TGA alone to calibrate",
            put(diagnosis={"calibrate": {"tga_10": ["mass_fraction"]}}),
            ("diagnosis.calibrate: a TGA alone shows nothing of the slab; add a gasification",),
        ),
        (
            "unknown experiment to hold out",
            put(diagnosis={"hold_out": {"slab_5": ["mlr"]}}),
            ("diagnosis.hold_out: unknown experiment 'slab_5'. Did you mean 'slab_50'?",),
        ),
        (
            "signal calibrated and held out",
            put(diagnosis={"hold_out": {"slab_25": ["mlr"]}}),
            ("diagnosis.hold_out.slab_25: 'mlr' is calibrated, too; leave it out, or list",),
        ),
        (
            "diagnosis of an unknown parameter",
            put(diagnosis={"estimate": ["rhoo"]}),
            ("diagnosis.estimate: unknown parameter 'rhoo'. Did you mean 'rho'?",),
        ),
        (
            "diagnosis of a parameter without limits",
            put(diagnosis={"estimate": ["rho", "k", "cp"]}),
            ("parameters.cp: diagnosis estimates it: give lower and upper limits",),
        ),
        (
            "diagnosis of a parameter twice",
            put(diagnosis={"estimate": ["rho", "k", "k"]}),
            ("diagnosis.estimate: a name stands twice; delete one",),
        ),
        (
            "diagnosis of a parameter that no signal shows",
            put(
                parameters__late={"unit": "s", "value": 0, "lower": -5, "upper": 5},
                experiments__slab_25__signals__mlr__delay_s="late",
                diagnosis={"calibrate": BACK, "estimate": ["rho", "k", "late"]},
            ),
            ("diagnosis.estimate: 'late' has no effect on any calibrated signal; leave it out",),
        ),
        (
            "parameter that the diagnosis lacks",
            put(diagnosis={"estimate": ["rho", "T_p", "E_p"]}),
            ("parameters.k: the diagnosis needs it; add it to diagnosis.estimate or give a value",),
        ),
        (
            "known value at its old place",
            put(diagnosis={"known": {"k": {"value": 0.2, "sd": 0.02}}}),
            ("diagnosis: known values hold for the whole study: move `known` to the top level",),
        ),
        (
            "known value of an unknown parameter",
            put(known={"rhoo": {"value": 1000, "sd": 20}}),
            ("known.rhoo: unknown parameter 'rhoo'. Did you mean 'rho'?",),
        ),
        (
            "known value of a fixed parameter",
            put(
                known={"eps": {"value": 0.9, "sd": 0.02}},
                parameters__eps={"unit": "-", "value": 0.9},
            ),
            (
                "known.eps: no stage estimates it, it has a fixed value. Name it under ",
                "give it limits, or leave it out here",
            ),
        ),
        (
            "known value outside the limits",
            put(known={"k": {"value": 0.5, "sd": 0.02}}),
            ("known.k.value: 0.5 lies outside the limits 0.1 to 0.4", "widen them"),
        ),
        (
            "known value without an error",
            put(known={"k": {"value": 0.2, "sd": 0}}),
            ("known.k.sd: 0 must be above 0",),
        ),
        (
            "unknown candidate",
            put(diagnosis={"effects": ["back_los"]}),
            ("diagnosis.effects: unknown effect 'back_los'. Did you mean 'back_loss'?",),
        ),
        (
            "candidate twice",
            put(diagnosis={"effects": ["k_T", "k_T"]}),
            ("diagnosis.effects: a name stands twice; delete one",),
        ),
        (
            "candidate without a foil",
            put(
                experiments__slab_25__sample__foil=None,
                diagnosis={"effects": ["foil_mass"]},
            ),
            ("'foil_mass' cannot be a candidate: no calibrated signal", "it needs a foil on"),
        ),
        (
            "candidate of a signal that is not calibrated",
            put(diagnosis={"calibrate": BACK, "effects": ["balance_drift"]}),
            ("'balance_drift' cannot be a candidate: ", "needs a mass loss rate; leave it out"),
        ),
        (
            "candidate of the model",
            put(effects={"k_T": {"slope_1_K": -1e-3}}, diagnosis={"effects": ["k_T"]}),
            ("'k_T' cannot be a candidate: the model has it already; leave it out",),
        ),
        (
            "candidate whose number is set",
            put(experiments__slab_25__front__rise_time_s=5, diagnosis={"effects": ["heater_ramp"]}),
            ("'heater_ramp' cannot be a candidate", "already sets rise_time_s (5.0)"),
        ),
        ("no effect at most", put(diagnosis={"most_effects": 0}), ("0 must be at least 1",)),
        ("seven effects at most", put(diagnosis={"most_effects": 7}), ("7 must be at most 6",)),
        (
            "clock that is too right",
            put(experiments__slab_25__signals__mlr__timing_s=-1),
            ("signals.mlr.timing_s: -1 must be at least 0",),
        ),
        (
            "unknown effect of the truth",
            truth(back_los={"factor": 0.5}),
            ("synthetic.effects: unknown effect 'back_los'. Did you mean 'back_loss'?",),
        ),
        (
            "unknown number of an effect of the truth",
            truth(back_loss={"facto": 0.5}),
            ("effects: effect 'back_loss': unknown parameter 'facto'. Did you mean 'factor'?",),
        ),
        (
            "effect of the truth without its strength",
            truth(melting={"width_K": 9}),
            ("synthetic.effects: effect 'melting': give its strength 'heat_J_kg'",),
        ),
        (
            "effect of the truth beyond its limits",
            truth(back_loss={"factor": 3}),
            ("synthetic.effects.back_loss.factor: 3 lies outside the limits 0 to 2.5 of the cata",),
        ),
        (
            "effect of the truth by the name of a parameter",
            truth(back_loss={"factor": "eps"}),
            ("synthetic.effects.back_loss.factor: 'eps' is not a number",),
        ),
        (
            "effect of the truth that is not computed",
            truth(tga_lag={"time_s": 5}),
            ("synthetic.effects: effect 'tga_lag': no experiment can have it; it needs",),
        ),
        (
            "effect of the truth and of the model",
            put(
                effects={"back_loss": {"factor": 0.8}},
                experiments__slab_25__signals__mlr={"file": "synthetic"},
                synthetic={**SYNTHETIC, "effects": {"back_loss": {"factor": 0.5}}},
            ),
            ("synthetic.effects.back_loss: the model has this effect, too; leave it out",),
        ),
    ],
)
