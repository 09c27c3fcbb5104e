"""Results, places and commands that are refused."""

import math

from bad_input import (
    GONE,
    RESULTS,
    Break,
    Case,
    cut,
    delete,
    edit,
    folder,
    full_disk,
    nothing,
    put,
    read_only,
    result,
    results_in_a_file,
    table,
    write,
)

AGAIN = "delete it and run again"
KINETICS = "kinetics --study study.yaml"
IMP = "imp --study study.yaml --cost RMSE --repetition 0"
IDENTIFY = "identify --stage kinetics --study study.yaml"
COLLECT = "collect --study study.yaml"
DESCENT = "descent --study study.yaml --cost RMSE"
PREDICT = "predict --study study.yaml"
SERIES = f"{RESULTS}/measurements/tga_10_mass_fraction.csv"
FIT = f"{RESULTS}/kinetics/fit.json"
SUMMARY = "imp/summary.csv"


def _results(rows: list[tuple[str, str, Break, str, tuple[str, ...]]]) -> list[Case]:
    return [
        Case(name, command, broken, (f"error: {RESULTS}/{path}: ", *words))
        for name, command, broken, path, words in rows
    ]


BROKEN_RESULTS = _results(
    [
        (
            "series missing",
            KINETICS,
            delete(SERIES),
            "measurements/tga_10_mass_fraction.csv",
            ("this result is missing; run the workflow to make it",),
        ),
        (
            "series empty",
            KINETICS,
            write(SERIES, ""),
            "measurements/tga_10_mass_fraction.csv",
            ("cannot be read", AGAIN),
        ),
        (
            "series without rows",
            KINETICS,
            write(SERIES, "time_s,temperature_K,mass_fraction\n"),
            "measurements/tga_10_mass_fraction.csv",
            ("'time_s' is missing or empty", AGAIN),
        ),
        (
            "series without a column",
            KINETICS,
            edit(SERIES, "temperature_K", "T"),
            "measurements/tga_10_mass_fraction.csv",
            ("the column 'temperature_K' is missing or empty", AGAIN),
        ),
        (
            "text in a series",
            KINETICS,
            edit(SERIES, "450.0", "warm"),
            "measurements/tga_10_mass_fraction.csv",
            ("'temperature_K' does not hold numbers", AGAIN),
        ),
        (
            "gap in a series",
            KINETICS,
            edit(SERIES, "450.0", ""),
            "measurements/tga_10_mass_fraction.csv",
            ("'temperature_K' does not hold numbers", AGAIN),
        ),
        (
            "series is a folder",
            KINETICS,
            folder(SERIES),
            "measurements/tga_10_mass_fraction.csv",
            ("cannot be read (", AGAIN),
        ),
        (
            "estimates of the kinetics missing",
            IMP,
            delete(f"{RESULTS}/identification/kinetics/estimate.csv"),
            "identification/kinetics/estimate.csv",
            ("this result is missing",),
        ),
        ("fit missing", IDENTIFY, delete(FIT), "kinetics/fit.json", ("this result is missing",)),
        ("fit empty", IDENTIFY, write(FIT, ""), "kinetics/fit.json", ("cannot be read", AGAIN)),
        ("fit cut off", IDENTIFY, cut(FIT), "kinetics/fit.json", ("cannot be read", AGAIN)),
        (
            "fit binary",
            IDENTIFY,
            write(FIT, b"\xff\xfe"),
            "kinetics/fit.json",
            ("cannot be read", AGAIN),
        ),
        ("fit is a list", IDENTIFY, write(FIT, "[1]"), "kinetics/fit.json", ("no result", AGAIN)),
        (
            "fit without parameters",
            IDENTIFY,
            result("kinetics/fit.json", "parameters", GONE),
            "kinetics/fit.json",
            ("'parameters' is missing in this result", AGAIN),
        ),
        (
            "fit without one parameter",
            IDENTIFY,
            result("kinetics/fit.json", "parameters.E_p", GONE),
            "kinetics/fit.json",
            ("'parameters.E_p' is missing in this result", AGAIN),
        ),
        (
            "fit with text for a number",
            IDENTIFY,
            result("kinetics/fit.json", "parameters.E_p", "high"),
            "kinetics/fit.json",
            ("'parameters.E_p' is not a finite number", AGAIN),
        ),
        (
            "fit with true for a number",
            IDENTIFY,
            result("kinetics/fit.json", "parameters.E_p", True),
            "kinetics/fit.json",
            ("'parameters.E_p' is not a finite number", AGAIN),
        ),
        (
            "fit with nan",
            IDENTIFY,
            result("kinetics/fit.json", "parameters.E_p", math.nan),
            "kinetics/fit.json",
            ("'parameters.E_p' is not a finite number", AGAIN),
        ),
        (
            "fit with a list for a mapping",
            IDENTIFY,
            result("kinetics/fit.json", "parameters", []),
            "kinetics/fit.json",
            ("'parameters' is not a mapping", AGAIN),
        ),
        (
            "repetition missing",
            COLLECT,
            delete(f"{RESULTS}/imp/RMSE/00.json"),
            "imp/RMSE/00.json",
            ("this result is missing",),
        ),
        (
            "repetition without its cost",
            COLLECT,
            result("imp/RMSE/00.json", "cost", GONE),
            "imp/RMSE/00.json",
            ("'cost' is missing in this result", AGAIN),
        ),
        (
            "repetition of another study",
            COLLECT,
            result("imp/RMSE/00.json", "digest", "0"),
            "imp/RMSE/00.json",
            ("belongs to another description of the study", "Run it again"),
        ),
        (
            "course of a repetition without a column",
            COLLECT,
            edit(f"{RESULTS}/imp/RMSE/00_convergence.csv", "best_cost", "cost"),
            "imp/RMSE/00_convergence.csv",
            ("'best_cost' is missing or empty", AGAIN),
        ),
        (
            "summary without a cost",
            DESCENT,
            table(SUMMARY, lambda f: f[f["cost_function"] != "RMSE"]),
            SUMMARY,
            ("the row of cost_function 'RMSE' is missing", AGAIN),
        ),
        (
            "summary of another cost",
            DESCENT,
            table(SUMMARY, lambda f: f.replace("RANGE", "BANDS")),
            SUMMARY,
            ("the row of cost_function 'BANDS' is of another study", AGAIN),
        ),
        (
            "summary without a parameter",
            DESCENT,
            table(SUMMARY, lambda f: f.drop(columns="rho")),
            SUMMARY,
            ("the column 'rho' is missing or empty", AGAIN),
        ),
        (
            "summary with text",
            DESCENT,
            table(SUMMARY, lambda f: f.assign(rho="x")),
            SUMMARY,
            (AGAIN,),
        ),
        (
            "least squares without starts",
            PREDICT,
            result("imp/RMSE/least_squares.json", "starts", []),
            "imp/RMSE/least_squares.json",
            ("'starts' is not a list of at least one", AGAIN),
        ),
        (
            "CMA-ES without starts",
            PREDICT,
            result("imp/RMSE/cmaes.json", "starts", []),
            "imp/RMSE/cmaes.json",
            ("'starts' is not a list of at least one", AGAIN),
        ),
        (
            "least squares without a parameter",
            PREDICT,
            result("imp/RMSE/least_squares.json", "starts.0.parameters.k", GONE),
            "imp/RMSE/least_squares.json",
            ("'starts.0.parameters.k' is missing", AGAIN),
        ),
        (
            "table 3 of a fit without sets",
            "show --study study.yaml --name table3",
            result("kinetics/sets.json", "book", GONE),
            "kinetics/sets.json",
            ("'book' is missing in this result", AGAIN),
        ),
        (
            "table 3 of scores cut off",
            "show --study study.yaml --name table3",
            table("kinetics/scores.csv", lambda f: f.iloc[:1]),
            "kinetics/scores.csv",
            ("the row of experiment 'tga_10', set 'book' is missing", AGAIN),
        ),
        (
            "table 4 of an empty summary",
            "show --study study.yaml --name table4",
            write(f"{RESULTS}/{SUMMARY}", ""),
            SUMMARY,
            ("cannot be read", AGAIN),
        ),
        (
            "costs of a descent without end",
            "show --study study.yaml --name costs",
            result("imp/RANGE/descent.json", "end", GONE),
            "imp/RANGE/descent.json",
            ("'end' is missing in this result", AGAIN),
        ),
        (
            "validation of scores cut off",
            "show --study study.yaml --name validation",
            table("validation/scores.csv", lambda f: f.iloc[:-1]),
            "validation/scores.csv",
            ("the row of experiment 'slab_50', signal 'mlr', set", "is missing", AGAIN),
        ),
        (
            "Fig. 2 of curves without masses",
            "show --study study.yaml --name fig2",
            table("kinetics/curves.csv", lambda f: f.drop(columns="mass_fraction")),
            "kinetics/curves.csv",
            ("the column 'mass_fraction' is missing or empty", AGAIN),
        ),
        (
            "Fig. 3 of curves of other sets",
            "show --study study.yaml --name fig3",
            table("validation/curves.csv", lambda f: f[f["set"] != "RMSE published"]),
            "validation/curves.csv",
            ("set 'RMSE published' is missing", AGAIN),
        ),
        (
            "Fig. 5 without a column",
            "show --study study.yaml --name fig5",
            table("imp/convergence.csv", lambda f: f.drop(columns="calls")),
            "imp/convergence.csv",
            ("the column 'calls' is missing or empty", AGAIN),
        ),
        (
            "report without a checksum",
            "report --study study.yaml",
            result("measurements/summary.json", "signals.slab_25.mlr.sha256", GONE),
            "measurements/summary.json",
            ("'signals.slab_25.mlr.sha256' is missing", AGAIN),
        ),
    ]
)

# --- commands and places --------------------------------------------------------------------

PLACES = [
    Case(
        "disk full",
        "prepare --study study.yaml",
        full_disk,
        (
            f"error: {RESULTS}/running/",
            "cannot be written (No space left on device)",
            "make room or choose another folder. Everything finished before is kept.",
        ),
    ),
    Case(
        "folder that takes no files",
        "prepare --study study.yaml --results /proc/nowhere",
        nothing,
        ("error: /proc/nowhere/", "cannot be written", "choose another folder"),
    ),
    Case(
        "read-only folder",
        "prepare --study study.yaml",
        read_only,
        (f"error: {RESULTS}/running/", "cannot be written (Read-only file system)"),
    ),
    Case(
        "results folder is a file",
        "prepare --study study.yaml --results taken",
        results_in_a_file,
        ("error: taken/", "cannot be written", "choose another folder"),
    ),
    Case(
        "disk full for the log",
        "prepare --study study.yaml --log /dev/full",
        nothing,
        ("error: /dev/full: cannot be written (No space left on device)", "with --log"),
    ),
    Case(
        "log is a folder",
        "prepare --study study.yaml --log data",
        nothing,
        ("error: data: cannot be written (Is a directory)", "name another file with --log"),
    ),
    Case(
        "study that cannot be read",
        "check /proc/self/mem",
        nothing,
        ("error: /proc/self/mem: cannot be read (Input/output error)", "check its permissions"),
    ),
    Case(
        "study in a folder that is a file",
        "check study.yaml/mine.yaml",
        nothing,
        ("error: study.yaml/mine.yaml: cannot be read (Not a directory)",),
    ),
    Case(
        "study beside the one that is meant",
        "check stdy.yaml",
        nothing,
        ("error: stdy.yaml: there is no such study file. Did you mean 'study.yaml'?",),
    ),
    Case(
        "results of a broken study",
        "collect --study study.yaml",
        put(seed=-1),
        ("error: study.yaml: the study description breaks a rule", "seed: -1 must be at least 0"),
    ),
]
COMMANDS = [
    Case("no command", "", nothing, ("usage: pyrofit", "required: COMMAND")),
    Case("unknown command", "calibrate", nothing, ("no command 'calibrate'", "pyrofit run STUDY")),
    Case("unknown option", "check study.yaml --fast", nothing, ("unrecognized arguments: --fast",)),
    Case("no study", "check", nothing, ("the following arguments are required: study",)),
    Case("repetition that is no number", IMP[:-1] + "one", nothing, ("invalid int value: 'one'",)),
    Case(
        "repetition out of range",
        IMP[:-1] + "1",
        nothing,
        ("repetition 1: study 'small' has repetitions 0 to 0; raise imp.repetitions for more",),
    ),
    Case("negative repetition", IMP[:-1] + "-1", nothing, ("repetition -1: study 'small' has",)),
    Case(
        "unknown cost",
        IMP.replace("RMSE", "RMES"),
        nothing,
        ("error: study.yaml: study 'small' has no cost 'RMES'. Did you mean 'RMSE'?",),
    ),
    Case(
        "unknown table",
        "show --study study.yaml --name tabel4",
        nothing,
        ("error: unknown table or figure 'tabel4'. Did you mean 'table4'?",),
    ),
    Case(
        "unknown figure",
        "show --study study.yaml --name fig22",
        nothing,
        ("error: unknown table or figure 'fig22'. Did you mean 'fig2'?",),
    ),
    Case(
        "table that the study does not have",
        "show --study study.yaml --name table3",
        put(
            kinetics=GONE,
            imp__kinetics="described",
            parameters__T_p__value=605,
            parameters__E_p__value=190,
        ),
        ("study 'small' has no table3: it lacks the contents of the table",),
    ),
    Case(
        "kinetics that the study does not have",
        KINETICS,
        put(
            kinetics=GONE,
            imp__kinetics="described",
            parameters__T_p__value=605,
            parameters__E_p__value=190,
        ),
        ("study 'small' has no kinetics stage; add `kinetics:` to it",),
    ),
]
