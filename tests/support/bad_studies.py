"""Studies that are refused before anything is read."""

import math

import yaml
from bad_input import (
    CHECK,
    GONE,
    MLR,
    POLYMER,
    STUDY,
    SYNTHETIC,
    delete,
    folder,
    line_of,
    put,
    rows_of,
    study,
    write,
)

NO_STUDY = rows_of(
    CHECK,
    ("error: study.yaml: ",),
    [
        ("study file missing", delete("study.yaml"), ("there is no such study file",)),
        ("study file is a folder", folder("study.yaml"), ("a directory; give the study's YAML",)),
        ("study file empty", write("study.yaml", ""), ("file is empty", "config/twin.yaml")),
        ("study file of comments", write("study.yaml", "# later\n"), ("this file is empty",)),
        ("study file binary", write("study.yaml", bytes(range(256))), ("UTF-8",)),
        (
            "study file with control characters",
            write("study.yaml", "name: a\nseed: \x07\n"),
            ("line 2", "the character #x07 is none of a text file; delete it"),
        ),
        (
            "study file in Latin-1",
            write("study.yaml", "name: a\ntitle: K\xf6hler\n".encode("latin-1")),
            ("line 2: byte 0xf6 is not UTF-8", "save the file as text in UTF-8"),
        ),
        (
            "study file in UTF-16",
            write("study.yaml", STUDY.encode("utf-16")),
            ("line 1: byte 0xff is not UTF-8",),
        ),
        (
            "list for a study",
            write("study.yaml", "- name: a\n- seed: 1\n"),
            ("a study is a mapping of keys; this is a list",),
        ),
        ("text for a study", write("study.yaml", "hello\n"), ("mapping of keys; this is text",)),
        ("number for a study", write("study.yaml", "5\n"), ("mapping of keys; this is a number",)),
        (
            "tabs",
            study("  repetitions: 1", "\trepetitions: 1"),
            (
                f"line {line_of('  repetitions: 1')}:",
                "character '\\t'",
                "indent with spaces, not with tabs",
            ),
        ),
        (
            "bracket not closed",
            study("estimate: [rho, k]", "estimate: [rho, k"),
            (
                f"not valid yaml, line {line_of('  kinetics: fitted')}:",
                "check the indentation, colons, quotes and brackets",
            ),
        ),
        ("quote not closed", study("title: A", 'title: "A'), ("not valid yaml, line",)),
        (
            "indentation",
            study("\nseed: 3", "\n  seed: 3"),
            ("not valid yaml, line 3:", "check the indentation"),
        ),
        (
            "unknown anchor",
            study("<<: *slab", "<<: *slap"),
            (
                f"line {line_of('    <<: *slab')}: found undefined alias 'slap'",
                "mark the repeated part with &",
            ),
        ),
        (
            "merge of no mapping",
            study("<<: *slab", "<<: 5"),
            (f"line {line_of('    <<: *slab')}: expected a mapping or list of mappings",),
        ),
        (
            "anchor inside itself",
            study("published:", "extra: &a [*a]\npublished:"),
            ("inside itself", "write it out"),
        ),
        (
            "nested without end",
            write("study.yaml", "a: " + "[" * 5000),
            ("nested too deep", "write it flatter"),
        ),
        (
            "python object",
            study("name: small", "name: !!python/name:os.system"),
            ("line 1: could not determine a constructor", "leave the tag out"),
        ),
        (
            "impossible date",
            study("seed: 3", "seed: 2020-13-45"),
            ("a date or number that cannot be (month must be in 1..12)", "quotes"),
        ),
        (
            "key twice at the top",
            study("seed: 3", "seed: 3\nname: other"),
            ("line 4: the key 'name' stands twice, first in line 1", "delete or rename one"),
        ),
        (
            "key twice far below",
            study("kind: RMSE, norm", "kind: RMSE, kind: NRSE, norm"),
            (f"line {line_of('    RMSE: [')}: the key 'kind' stands twice, first in line",),
        ),
        (
            "parameter twice",
            study("  dh: {", "  k: {unit: K, value: 3}\n  dh: {"),
            ("line 11: the key 'k' stands twice, first in line 8",),
        ),
    ],
)

# --- keys and values ------------------------------------------------------------------------

KEYS = rows_of(
    CHECK,
    ("error: study.yaml: the study description breaks a rule:\n  ",),
    [
        ("unknown key at the top", put(sed=1), ("unknown key 'sed'. Did you mean 'seed'?",)),
        (
            "unknown key of a parameter",
            put(parameters__rho__uper=3),
            ("parameters.rho: unknown key 'uper'. Did you mean 'upper'?",),
        ),
        (
            "unknown key of a component",
            put(material__components__wood__density=3),
            (f"{POLYMER}: unknown key 'density'. Did you mean 'density_kg_m3'?",),
        ),
        (
            "unknown key of a reaction",
            put(material__reactions__pyrolysis__orders=3),
            ("material.reactions.pyrolysis: unknown key 'orders'. Did you mean 'order'?",),
        ),
        (
            "unknown key of an experiment",
            put(experiments__tga_10__heating_rate=3),
            ("experiments.tga_10: unknown key", "Did you mean 'heating_rate_K_min'?"),
        ),
        (
            "unknown key of a layer",
            put(experiments__slab_25__sample__layers__0__thickness=3),
            ("experiments.slab_25.sample.layers.0:", "Did you mean 'thickness_m'?"),
        ),
        (
            "unknown key of a side",
            put(experiments__slab_25__front__flux=3),
            ("experiments.slab_25.front: unknown key 'flux'. Did you mean 'flux_W_m2'?",),
        ),
        (
            "unknown key of a signal",
            put(experiments__slab_25__signals__mlr__files=3),
            (f"{MLR}: unknown key 'files'. Did you mean 'file'?",),
        ),
        (
            "unknown key of a term",
            put(imp__costs__RMSE__0__wieght=3),
            ("imp.costs.RMSE.0: unknown key 'wieght'. Did you mean 'weight'?",),
        ),
        (
            "unknown key of a budget",
            put(imp__sceua__generation=3),
            ("imp.sceua: unknown key 'generation'. Did you mean 'generations'?",),
        ),
        (
            "unknown key of the accuracy",
            put(accuracy__cell=3),
            ("accuracy: unknown key 'cell'. Did you mean 'cells'?",),
        ),
        ("missing key at the top", put(imp=GONE), ("imp: this key is missing, and is required",)),
        (
            "missing unit",
            put(parameters__rho__unit=GONE),
            ("parameters.rho.unit: this key is missing",),
        ),
        (
            "missing flux",
            put(experiments__slab_25__front={}),
            ("experiments.slab_25.front.flux_W_m2: this key is missing",),
        ),
        (
            "missing file",
            put(**{MLR.replace(".", "__"): {}}),
            (f"{MLR}.file: this key is missing",),
        ),
        ("missing kind", put(experiments__tga_10__kind=GONE), ("tga_10: 'kind' is missing",)),
        (
            "text for a number",
            put(parameters__rho__lower="low"),
            ("parameters.rho.lower: 'low' is not a number",),
        ),
        (
            "number with its unit",
            put(material__components__char__density_kg_m3="200 kg/m3"),
            ("density_kg_m3: '200 kg/m3' is neither a number nor the name of a parameter",),
        ),
        ("number for text", put(title=5), ("title: 5 is not text; put text in quotes",)),
        (
            "true for a number",
            put(seed=True),
            ("seed: no key takes true or false", "give a number, or put text in quotes"),
        ),
        ("no for a name", study("name: small", "name: no"), ("name: no key takes true or false",)),
        (
            "on for a key",
            study("  char: {dens", "  on: {dens"),
            ("material.components.True: no key takes true or false",),
        ),
        (
            "empty value for a number",
            study("density_kg_m3: 200", "density_kg_m3: "),
            ("density_kg_m3: an empty value is neither a number nor the name of a parameter",),
        ),
        ("empty value for a mapping", put(imp=None), ("imp: an empty value is not a mapping",)),
        ("list for a mapping", put(parameters=[1]), ("parameters: [1] is not a mapping of keys",)),
        ("mapping for a number", put(seed={"a": 1}), ("seed: {'a': 1} is not a whole number",)),
        ("text for a list", put(imp__estimate="rho"), ("imp.estimate: 'rho' is not a list",)),
        ("part of a number", put(seed=1.5), ("seed: 1.5 is not a whole number",)),
        (
            "infinite limit",
            put(parameters__rho__upper=math.inf),
            ("parameters.rho.upper: inf must be finite",),
        ),
        (
            "nan in a property",
            put(material__components__char__density_kg_m3=math.nan),
            ("material.components.char.density_kg_m3: nan must be finite",),
        ),
        (
            "decimal comma",
            study(
                "E_p: {unit: kJ/mol, lower: 100,", "E_p:\n    unit: kJ/mol\n    lower: 0,5\n   #"
            ),
            ("parameters.E_p.lower: '0,5' is not a number", "a decimal point: 0.5"),
        ),
        (
            "decimal comma between braces",
            study("lower: 0.1, upper: 0.4", "lower: 0,1, upper: 0.4"),
            ("parameters.k: unknown key '1'. A decimal comma? Write a point.",),
        ),
        (
            "decimal comma for a property",
            put(material__components__char__conductivity_W_mK="0,1"),
            ("conductivity_W_mK: '0,1' is neither", "numbers take a decimal point: 0.1"),
        ),
        ("name with a slash", put(name="a/b"), ("name: 'a/b' is no name; letters, digits",)),
        (
            "name of a cost with a slash",
            put(imp__costs={"a/b": []}),
            ("imp.costs.a/b: 'a/b' is no name; letters, digits and _ make one",),
        ),
        ("name with dots", put(name="../up"), ("name: '../up' is no name",)),
        ("negative seed", put(seed=-1), ("seed: -1 must be at least 0",)),
        (
            "repetitions without end",
            put(imp__repetitions=10**9),
            ("imp.repetitions: 1000000000 must be at most 100000",),
        ),
        ("0 repetitions", put(imp__repetitions=0), ("imp.repetitions: 0 must be at least 1",)),
        (
            "2 generations",
            put(imp__sceua__generations=2),
            ("imp.sceua.generations: 2 must be at least 3",),
        ),
        ("0 complexes", put(imp__sceua__complexes=0), ("imp.sceua.complexes: 0 must be at least",)),
        ("0 starts", put(imp__least_squares__starts=0), ("imp.least_squares.starts: 0 must be",)),
        (
            "0 starts of CMA-ES",
            put(imp__cmaes__starts=0),
            ("imp.cmaes.starts: 0 must be at least 1",),
        ),
        ("1 call", put(imp__cmaes__calls=1), ("imp.cmaes.calls: 1 must be at least 10",)),
        ("1 cell", put(accuracy__cells=1), ("accuracy.cells: 1 must be at least 2",)),
    ],
)

LIMITS = rows_of(
    CHECK,
    ("error: study.yaml: the study description breaks a rule:\n  ",),
    [
        (
            "limits swapped",
            put(parameters__rho__lower=1600),
            ("parameters.rho: lower (1600) must be below upper (1500)",),
        ),
        (
            "limits equal",
            put(parameters__rho__lower=1500),
            ("parameters.rho: lower (1500) must be below upper (1500)",),
        ),
        (
            "one limit only",
            put(parameters__rho__upper=GONE),
            ("parameters.rho: give both limits, lower and upper, or none",),
        ),
        (
            "neither value nor limits",
            put(parameters__dh__value=GONE),
            ("parameters.dh: give a value, or limits to estimate it within",),
        ),
        (
            "value outside its limits",
            put(parameters__eps__value=0.3),
            ("parameters.eps.value: 0.3 lies outside the limits 0.5 to 0.99", "widen them"),
        ),
        (
            "unknown unit",
            put(parameters__rho__unit="g/cm3"),
            ("parameters.rho: unknown unit 'g/cm3'; known:", "kg/m3"),
        ),
        (
            "unit of another quantity",
            put(parameters__rho__unit="W/(m K)"),
            ("parameters.rho.unit: 'W/(m K)' is no unit of", "density_kg_m3", "give kg/m3"),
        ),
        (
            "unit of a heat for an energy",
            put(parameters__E_p__unit="kJ/kg"),
            ("parameters.E_p.unit: 'kJ/kg' is no unit of", "kJ/mol"),
        ),
        (
            "limits that allow a negative density",
            put(parameters__rho__lower=-1),
            ("parameters.rho.lower: -1.0 must be above 0", f"used as {POLYMER}.density_kg_m3"),
        ),
        (
            "limits that allow an emissivity above one",
            put(parameters__eps__upper=1.1),
            ("parameters.eps.upper: 1.1 must lie within 0 and 1", f"used as {POLYMER}.emissivity"),
        ),
        (
            "yield above one through a limit",
            put(
                material__reactions__pyrolysis__products={"char": "nu", "wood2": 0.5},
                material__components__wood2=yaml.safe_load(STUDY)["material"]["components"]["char"],
                parameters__nu={"unit": "-", "lower": 0.1, "upper": 0.6},
                imp__estimate=["rho", "k", "nu"],
            ),
            ("products: with the upper limits of parameters these add up to 1.1", "lower a limit"),
        ),
        (
            "estimated without limits",
            put(imp__estimate=["rho", "k", "cp"]),
            ("parameters.cp: imp estimates it: give lower and upper limits",),
        ),
        (
            "estimated and used nowhere",
            put(
                parameters__spare={"unit": "K", "lower": 1, "upper": 2},
                imp__estimate=["rho", "k", "spare"],
            ),
            ("imp.estimate: 'spare' has no effect on any gasification experiment",),
        ),
        (
            "parameter used nowhere",
            put(parameters__spare={"unit": "K", "value": 300}),
            ("parameters.spare: nothing uses it", "delete it"),
        ),
        (
            "undefined parameter",
            put(material__components__wood__density_kg_m3="roh"),
            (f"{POLYMER}.density_kg_m3: unknown parameter 'roh'. Did you mean 'rho'?",),
        ),
        (
            "undefined parameter to estimate",
            put(imp__estimate=["rho", "K"]),
            ("imp.estimate: unknown parameter 'K'.", "Known: E_p, T_p, cp,"),
        ),
        (
            "parameter estimated twice",
            put(imp__estimate=["k", "k"]),
            ("imp.estimate: a name stands twice; delete one",),
        ),
        (
            "neither estimated nor given",
            put(imp__estimate=["rho"]),
            ("parameters.k: neither estimated in imp nor given a value", "give a value"),
        ),
        (
            "nothing to estimate",
            put(imp__estimate=[]),
            ("imp.estimate: with 0 items this is too short",),
        ),
    ],
)

PHYSICS = rows_of(
    CHECK,
    ("error: study.yaml: the study description breaks a rule:\n  ",),
    [
        (
            "density 0",
            put(material__components__char__density_kg_m3=0),
            ("material.components.char.density_kg_m3: 0 must be above 0",),
        ),
        (
            "negative conductivity",
            put(material__components__char__conductivity_W_mK=-0.1),
            ("material.components.char.conductivity_W_mK: -0.1 must be above 0",),
        ),
        (
            "specific heat 0",
            put(material__components__char__specific_heat_J_kgK=0),
            ("material.components.char.specific_heat_J_kgK: 0 must be above 0",),
        ),
        (
            "thickness 0",
            put(experiments__slab_25__sample__layers=[{"thickness_m": 0}]),
            ("experiments.slab_25.sample.layers.0.thickness_m: 0 must be above 0",),
        ),
        (
            "thickness in mm",
            put(experiments__slab_25__sample__layers=[{"thickness_m": 5.8}]),
            ("layers.0.thickness_m: 5.8 must be at most 0.5", "in m, and 5 mm are 0.005"),
        ),
        (
            "foil in mm",
            put(experiments__slab_25__sample__foil__thickness_m=25),
            ("foil.thickness_m: 25 must be at most 0.5: thicknesses are in m",),
        ),
        (
            "gas temperature in degrees C",
            put(experiments__slab_25__front__gas_temperature_K=20),
            ("front.gas_temperature_K: 20 must be at least 150", "in K, and 20 °C is 293.15"),
        ),
        (
            "wall temperature in degrees C",
            put(experiments__slab_25__back__wall_temperature_K=25),
            ("back.wall_temperature_K: 25 must be at least 150: temperatures are in K",),
        ),
        (
            "initial temperature in degrees C",
            put(experiments__slab_25__sample__initial_temperature_K=20),
            ("sample.initial_temperature_K: 20 must be at least 150: temperatures are in K",),
        ),
        (
            "temperature below absolute zero",
            put(experiments__slab_25__sample__initial_temperature_K=-3),
            ("sample.initial_temperature_K: -3 must be above 0",),
        ),
        (
            "emissivity above one",
            put(material__components__char__emissivity=1.2),
            ("material.components.char.emissivity: 1.2 must lie within 0 and 1",),
        ),
        (
            "negative flux",
            put(experiments__slab_25__front__flux_W_m2=-1),
            ("experiments.slab_25.front.flux_W_m2: -1 must not be negative",),
        ),
        (
            "negative heat transfer coefficient",
            put(experiments__slab_25__front__h_W_m2K=-1),
            ("experiments.slab_25.front.h_W_m2K: -1 must not be negative",),
        ),
        (
            "negative A",
            put(
                material__reactions__pyrolysis={"reactant": "wood", "A_1_s": -1, "E_J_mol": 1e5},
            ),
            ("material.reactions.pyrolysis.A_1_s: -1 must be above 0",),
        ),
        (
            "negative A of a published set",
            put(kinetics__sets__book__reactions__pyrolysis__A_1_s=-1),
            ("kinetics.sets.book.reactions.pyrolysis.A_1_s: -1 must be above 0",),
        ),
        (
            "negative energy",
            put(material__reactions__pyrolysis__E_J_mol=-1),
            ("material.reactions.pyrolysis.E_J_mol: -1 must not be negative",),
        ),
        (
            "negative order",
            put(material__reactions__pyrolysis__order=-1),
            ("material.reactions.pyrolysis.order: -1 must not be negative",),
        ),
        (
            "A and a reference",
            put(material__reactions__pyrolysis__A_1_s=1e13),
            ("pyrolysis: give either A_1_s or the reference pair, not both",),
        ),
        (
            "fractions that do not add up",
            put(material__composition={"wood": 0.9}),
            ("material: the mass fractions add up to 0.9, not to 1",),
        ),
        (
            "two rests",
            put(material__composition={"wood": "rest", "char": "rest"}),
            ("material: only one component may be 'rest'",),
        ),
        (
            "unknown component",
            put(material__composition={"wod": 1.0}),
            ("material: unknown component 'wod'. Did you mean 'wood'?",),
        ),
        (
            "unknown reactant",
            put(material__reactions__pyrolysis__reactant="wod"),
            ("reaction 'pyrolysis' uses the unknown component 'wod'. Did you mean 'wood'?",),
        ),
        (
            "reactant as its own product",
            put(material__reactions__pyrolysis__products={"wood": 0.5}),
            ("material: reaction 'pyrolysis' forms its own reactant 'wood'; take it out",),
        ),
        (
            "cycle of reactions",
            put(
                material__reactions__back={
                    "reactant": "char",
                    "products": {"wood": 0.5},
                    "A_1_s": 1.0,
                    "E_J_mol": 1.0,
                }
            ),
            ("material: the reactions of wood, char form a cycle; take one out",),
        ),
        (
            "yield above one",
            put(material__reactions__pyrolysis__products={"char": 1.5}),
            ("pyrolysis: the solid yields add up to 1.5, above 1",),
        ),
        (
            "negative yield",
            put(material__reactions__pyrolysis__products={"char": -0.5}),
            ("pyrolysis.products.char: -0.5 must lie within 0 and 1",),
        ),
        (
            "flux table decreasing",
            put(experiments__slab_25__front__flux_W_m2={"time_s": [0, 9, 3], "value": [1, 1, 1]}),
            ("front.flux_W_m2: time_s must not decrease",),
        ),
        (
            "flux table that starts late",
            put(experiments__slab_25__front__flux_W_m2={"time_s": [5, 9], "value": [1, 1]}),
            ("front.flux_W_m2: time_s must start at 0",),
        ),
        (
            "flux table of two lengths",
            put(experiments__slab_25__front__flux_W_m2={"time_s": [0, 9], "value": [1]}),
            ("front.flux_W_m2: time_s and value need the same length",),
        ),
        (
            "negative flux in a table",
            put(experiments__slab_25__front__flux_W_m2={"time_s": [0, 9], "value": [1, -1]}),
            ("front.flux_W_m2.value.1: -1 must not be negative",),
        ),
        (
            "property table decreasing",
            put(
                material__components__char__conductivity_W_mK={
                    "temperature_K": [400, 300],
                    "value": [1, 1],
                }
            ),
            ("char.conductivity_W_mK: temperature_K must increase",),
        ),
        (
            "heating rate 0",
            put(experiments__tga_10__heating_rate_K_min=0),
            ("experiments.tga_10.heating_rate_K_min: 0 must be above 0",),
        ),
        (
            "unknown kind of experiment",
            put(experiments__tga_10__kind="oven"),
            ("experiments.tga_10: unknown 'kind' 'oven'; known: 'cone', ",),
        ),
        ("no experiments", put(experiments={}), ("experiments: ", "at least 1")),
    ],
)

STAGES = rows_of(
    CHECK,
    ("error: study.yaml: the study description breaks a rule:\n  ",),
    [
        (
            "unknown experiment in a term",
            put(imp__costs__RMSE__0__experiment="slab25"),
            ("imp.costs.RMSE.0.experiment: unknown experiment 'slab25'. Did you mean 'slab_25'?",),
        ),
        (
            "unknown signal in a term",
            put(imp__costs__RMSE__0__signal="mrl"),
            ("imp.costs.RMSE.0.signal: experiment 'slab_25' has no signal 'mrl'. Did you",),
        ),
        (
            "signal that another experiment has",
            put(
                imp__costs__RMSE__0__experiment="slab_50",
                imp__costs__RMSE__0__signal="back_temperature",
            ),
            ("experiment 'slab_50' has no signal 'back_temperature'. Known: mlr.",),
        ),
        (
            "TGA in the inverse modelling",
            put(imp__costs__RMSE__0__experiment="tga_10"),
            (
                "imp.costs.RMSE.0.experiment: 'tga_10' is no cone calorimeter, gasification or "
                "external experiment",
            ),
        ),
        (
            "gasification in the kinetics",
            put(kinetics__cost__0__experiment="slab_25"),
            ("kinetics.cost.0.experiment: 'slab_25' is no TGA, DSC or MCC experiment.",),
        ),
        (
            "unknown kind of cost",
            put(imp__costs__RMSE__0__kind="RSME"),
            ("imp.costs.RMSE.0: unknown cost 'RSME'. Did you mean 'RMSE'?",),
        ),
        (
            "unknown option of a cost",
            put(imp__costs__RANGE__0__options={"R": 0.05}),
            ("imp.costs.RANGE.0: RANGE: unknown option 'R'.", "Known:"),
        ),
        (
            "option that is needed",
            put(imp__costs__RANGE__0={"experiment": "slab_25", "signal": "mlr", "kind": "NRSE"}),
            ("imp.costs.RANGE.0: NRSE: the option `time_s` is absent; the cost needs it. Give it",),
        ),
        (
            "unknown normalisation",
            put(imp__costs__RMSE__0__normalisation="men"),
            ("imp.costs.RMSE.0: unknown normalisation 'men'. Did you mean 'mean'?",),
        ),
        (
            "window reversed",
            put(imp__costs__RMSE__0__window_s=[100, 10]),
            ("imp.costs.RMSE.0: window_s must be [start, end] with start below end",),
        ),
        (
            "window of one time",
            put(imp__costs__RMSE__0__window_s=[100]),
            ("imp.costs.RMSE.0.window_s.1: this item of the list is missing",),
        ),
        ("1 point", put(imp__costs__RMSE__0__points=1), ("RMSE.0.points: 1 must be at least 2",)),
        (
            "negative weight",
            put(imp__costs__RMSE__0__weight=-1),
            ("weight: -1 must be at least 0",),
        ),
        ("no cost", put(imp__costs={}, published=GONE), ("imp.costs: ", "at least 1")),
        (
            "cost without weight",
            put(imp__costs__RMSE__0__weight=0),
            ("imp.costs.RMSE: no term has a weight above 0; give one to at least one of them",),
        ),
        (
            "cost without terms",
            put(imp__costs__RMSE=[]),
            ("imp.costs.RMSE: with 0 items this is too short; give at least 1",),
        ),
        (
            "fitted kinetics without a kinetics stage",
            put(kinetics=GONE),
            ("imp.kinetics: unknown kinetics 'fitted'. Known: described.",),
        ),
        (
            "unknown set of kinetics",
            put(imp__kinetics="bock"),
            ("imp.kinetics: unknown kinetics 'bock'. Did you mean 'book'?",),
        ),
        (
            "set of other reactions",
            put(kinetics__sets__book__reactions={}),
            ("kinetics.sets.book: reactions differ from the material's: ['pyrolysis']; give each",),
        ),
        (
            "set under a reserved name",
            put(kinetics__sets={"fitted": yaml.safe_load(STUDY)["kinetics"]["sets"]["book"]}),
            ("kinetics.sets.fitted: 'fitted' is a reserved name; choose another",),
        ),
        (
            "published cost unknown",
            put(published__costs={"RMES": {"rho": [1, 2, 3]}}),
            ("published.costs: unknown cost 'RMES'. Did you mean 'RMSE'?",),
        ),
        (
            "published parameter unknown",
            put(published__costs__RMSE={"rhoo": [1, 2, 3]}),
            ("published.costs.RMSE: unknown parameter 'rhoo'. Did you mean 'rho'?",),
        ),
        (
            "published limits of an unknown parameter",
            put(published__limits={"rhoo": [1, 2]}),
            ("published.limits: unknown parameter 'rhoo'. Did you mean 'rho'?",),
        ),
        (
            "published limits in the wrong order",
            put(published__limits={"rho": [2, 1]}),
            ("published.limits.rho: lower (2) must be below upper (1)",),
        ),
        (
            "unknown experiment to predict",
            put(validation__experiments=["slab_2"]),
            ("validation.experiments: unknown experiment 'slab_2'. Did you mean 'slab_25'?",),
        ),
        (
            "TGA to predict",
            put(validation__experiments=["tga_10"]),
            (
                "validation.experiments: 'tga_10' is no cone calorimeter, "
                "gasification or external experiment",
            ),
        ),
        (
            "nothing to predict",
            put(validation__experiments=[]),
            ("validation.experiments: with 0 items this is too short",),
        ),
        (
            "experiment without signals",
            put(experiments__slab_50__signals={}),
            ("experiments.slab_50.signals: empty; name a measured quantity: back_temp",),
        ),
        (
            "unknown signal",
            put(experiments__slab_50__signals={"heat": {"file": "data/mlr.csv"}}),
            (
                "experiments.slab_50: unknown signal 'heat'.",
                "Known: back_temperature, front_temperature,",
            ),
        ),
        (
            "temperature limit of a record without temperatures",
            put(experiments__slab_25__signals__mlr__until_K=600),
            (
                f"{MLR}.until_K: only a record against temperature has one at each point; "
                "use until_s",
            ),
        ),
        (
            "synthetic signal without synthetic section",
            put(experiments__slab_25__signals__mlr__file="synthetic"),
            ("synthetic: a signal has file: synthetic; give synthetic.truth",),
        ),
        (
            "truth missing",
            put(
                experiments__slab_25__signals__mlr__file="synthetic",
                synthetic={"truth": {"T_p": 605, "E_p": 190, "rho": 1190}},
            ),
            ("synthetic.truth: the true value of 'k' is missing; give it",),
        ),
        (
            "truth outside its limits",
            put(
                experiments__slab_25__signals__mlr__file="synthetic",
                synthetic={"truth": {**SYNTHETIC["truth"], "rho": 2000}},
            ),
            ("synthetic.truth.rho: 2000.0 lies outside the limits 900 to 1500", "widen"),
        ),
        (
            "truth that is impossible",
            put(
                experiments__slab_25__signals__mlr__file="synthetic",
                synthetic={"truth": {**SYNTHETIC["truth"], "rho": -1}},
            ),
            ("synthetic.truth.rho: -1.0 must be above 0", "density_kg_m3"),
        ),
        (
            "truth of an unknown parameter",
            put(
                experiments__slab_25__signals__mlr__file="synthetic",
                synthetic={"truth": {**SYNTHETIC["truth"], "rhoo": 1}},
            ),
            ("synthetic.truth: unknown parameter 'rhoo'. Did you mean 'rho'?",),
        ),
        (
            "synthetic record of two points",
            put(
                experiments__slab_25__signals__mlr={"file": "synthetic", "every": 600},
                synthetic=SYNTHETIC,
            ),
            (f"{MLR}.every: 600 leaves fewer than 3 points", "change duration_s"),
        ),
    ],
)
