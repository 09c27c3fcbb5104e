"""Measured files, and places of them, that are refused."""

from bad_input import (
    ABSENT,
    CHECK,
    MLR,
    SYNTHETIC,
    TGA,
    altered_file,
    both,
    delete,
    edit,
    folder,
    mlr,
    put,
    rows_of,
    study,
    tga,
    variable,
    write,
)

TABLES = rows_of(
    CHECK,
    (f"error: study.yaml: {TGA}: data/tga.csv",),
    [
        ("file missing", delete("data/tga.csv"), ("there is no such file.", "back.csv, mlr.csv")),
        ("file is a folder", folder("data/tga.csv"), ("this is a folder; give a file in it",)),
        ("file empty", write("data/tga.csv", ""), ("the file is empty; a header row and rows",)),
        (
            "header only",
            write("data/tga.csv", "Time,Temperature,Mass\n[s],[K],[mg]\n"),
            ("the file holds a header and no numbers; rows of numbers must follow it",),
        ),
        (
            "no header",
            write("data/tga.csv", "0,500,1\n1,501,1\n"),
            ("line 1: the first row holds numbers", "names of the columns must come first"),
        ),
        ("no time", tga("Time", "Clock"), ("no column is known to be the time", "columns: {time:")),
        (
            "no value",
            tga("Mass", "Weight"),
            ("no column is known to be the value of mass_fraction", "`columns: {value: ...}`"),
        ),
        (
            "two candidates",
            write(
                "data/tga.csv", "Time,Temperature,Mass,Mass fraction\n0,1,2,3\n1,1,2,3\n2,1,2,3\n"
            ),
            ("['Mass', 'Mass fraction'] may all be the value of mass_fraction; name the",),
        ),
        (
            "two columns of one name",
            tga("Temperature", "Time"),
            ("['Time (s)', 'Time (K)'] may all be the time", "`columns: {time: ...}`"),
        ),
        (
            "nameless column",
            tga("Temperature", ""),
            ("no column is known to be the temperature", "Known: Mass, Time, column 2"),
        ),
        (
            "unknown unit of a column",
            tga("[mg]", "[ounce]"),
            ("column 'Mass': unknown unit 'ounce'", "kg/kg", "`units: {value: ...}`"),
        ),
        ("no unit", tga("[s]", ""), ("column 'Time': no unit of the time; Known: h, min, s.",)),
        ("NaN", tga("\n60,460,", "\n60,NaN,"), ("line 4, column 'Temperature': given an empty",)),
        ("infinite", tga("5.00000", "-inf"), ("line 3, column 'Mass': given '-inf'",)),
        (
            "blank cell",
            tga("\n60,460,", "\n60,,"),
            ("line 4, column 'Temperature': given an empty",),
        ),
        ("blank row", tga("\n60,", "\n,,\n60,"), ("line 4: this row is blank but numbers follow",)),
        ("text in a column", tga("\n60,", "\nsoon,"), ("line 4, column 'Time': given 'soon'",)),
        (
            "decimal commas or thousands",
            write(
                "data/tga.csv",
                "Time (s);Temperature (K);Mass (mg)\n0;300;4,999\n1;301;4,998\n2;302;4,997\n",
            ),
            ("line 2, column 'Mass': given '4,999'; it may be 4.999, with a", "or 4999, with a"),
        ),
        (
            "decimal commas between commas",
            tga("\n60,460,", "\n60,0,460,0,"),
            (
                "line 4: given 5 cells; the header names 3 columns",
                "for decimal commas, write points",
            ),
        ),
        (
            "spaces for delimiters",
            write("data/tga.csv", "Time Temperature Mass\n0 300 1\n1 301 1\n"),
            ("header and no numbers", "their cells set apart by comma, semicolon or tab"),
        ),
        (
            "bars for delimiters",
            write("data/tga.csv", "Time|Temperature|Mass\n0|300|1\n1|301|1\n"),
            ("header and no numbers", "their cells set apart by comma, semicolon or tab"),
        ),
        (
            "another delimiter from the third row on",
            tga("\n60,460,", "\n60;460;"),
            ("line 4: given 1 cells; the header names 3 columns", "Complete the row or delete it"),
        ),
        ("row too long", tga("\n60,460,", "\n60,460,1,"), ("line 4: given 4 cells",)),
        ("row too short", tga("\n60,460,", "\n60,"), ("line 4: given 2 cells",)),
        (
            "time decreasing",
            tga("\n60,", "\n600,"),
            ("line 5, column 'Time': given 120; time must",),
        ),
        (
            "time goes back",
            tga("\n120,", "\n0,"),
            (
                "line 5, column 'Time': given 0; time must exceed",
                "Sort the rows and delete doubled",
            ),
        ),
        (
            "time before 0",
            tga("\n0,", "\n-900,"),
            ("line 3, column 'Time': given -900", "Delete the rows"),
        ),
        (
            "negative first mass",
            tga("5.00000", "-5"),
            ("given -5; a mass is not that far below 0", "correct the zero of the balance"),
        ),
        (
            "mass fraction of 9",
            tga("\n60,460,", "\n60,460,4"),
            ("line 4, column 'Mass': given 45", "not between 0.5 and 1.5", "`units: {value: ...}`"),
        ),
        (
            "degrees C for kelvins",
            tga("\n0,450,", "\n0,25,"),
            ("line 3, column 'Temperature': given 25", "degrees Celsius: degC"),
        ),
        (
            "zero throughout",
            write(
                "data/tga.csv", "Time (s),Temperature (K),Mass (mg)\n0,300,0\n1,301,0\n2,302,0\n"
            ),
            ("no column is known to be the value", "Zero throughout: Mass."),
        ),
        (
            "two points",
            write("data/tga.csv", "Time (s),Temperature (K),Mass (mg)\n0,300,1\n1,301,1\n"),
            ("given 2 points; a series needs at least 3. Give a longer file",),
        ),
        (
            "number too large for its unit",
            write(
                "data/tga.csv", "Time (h),Temperature (K),Mass (g)\n0,300,1\n1,301,1\n1e308,302,1\n"
            ),
            ("point 3: time_s is too large a number in SI units; correct the file or the unit",),
        ),
        (
            "spreadsheet",
            write("data/tga.csv", b"PK\x03\x04\x14\x00\xfc\x00"),
            ("this is a spreadsheet or an archive, no text; save or export the table as CSV",),
        ),
        (
            "limit that leaves two points",
            put(**{f"{TGA.replace('.', '__')}__until_s": 60}),
            ("until_K or until_s leaves 2 points; raise it",),
        ),
        (
            "unknown role of a column",
            put(**{f"{TGA.replace('.', '__')}__columns": {"valu": "Mass"}}),
            ("`columns` names an unknown role 'valu'", "Did you mean 'value'?"),
        ),
        (
            "column that is not there",
            put(**{f"{TGA.replace('.', '__')}__columns": {"value": "Mas"}}),
            ("there is no column 'Mas' for the value. Did you mean 'Mass'?",),
        ),
        (
            "unit for a column that is not read",
            put(**{f"{TGA.replace('.', '__')}__units": {"uncertainty": "mg"}}),
            (
                "a unit is given for the uncertainty, but no column is read for it",
                "leave the unit out",
            ),
        ),
        (
            "uncertainty twice",
            put(
                **{
                    f"{TGA.replace('.', '__')}__uncertainty": 1,
                    f"{TGA.replace('.', '__')}__columns": {"uncertainty": "x"},
                }
            ),
            ("both a number and a column are given for the uncertainty", "leave one of them out"),
        ),
    ],
) + rows_of(
    CHECK,
    ("error: study.yaml: ", "experiments.slab_25.signals.mlr: data/mlr.csv"),
    [
        (
            "negative uncertainty",
            mlr(",0.0005\n15", ",-0.0005\n15"),
            ("line 3, column 'MLR_error': given -0.0005; an uncertainty is never negative",),
        ),
        (
            "grams read as kilograms",
            mlr("\n155,0.0", "\n155,9.9"),
            ("line 18, column 'MLR': given 9.9", "If the unit is wrong, give the right one"),
        ),
        (
            "mass gained",
            edit("data/mlr.csv", "\n155,", "\n155,-9"),
            ("column 'MLR': given -9", "a mass loss rate is positive. Change"),
        ),
        (
            "mass rate without area",
            mlr("[kg/s/m2]", "[kg/s]"),
            ("the unit is that of a mass rate; give `sample_area_m2`",),
        ),
    ],
)
FILES_ELSEWHERE = rows_of(
    CHECK,
    ("error: study.yaml: ",),
    [
        (
            "two files at once",
            both(tga("\n60,", "\nsoon,"), delete("data/back.csv")),
            ("2 measured files cannot be used:", "given 'soon'", "data/back.csv: there is no such"),
        ),
        (
            "file name with a null character",
            study("{file: data/tga.csv}", '{file: "data/t\\0.csv"}'),
            (f"{TGA}: 'data/t\\x00.csv': this is no name of a file",),
        ),
        (
            "file that cannot be read",
            study("{file: data/tga.csv}", "{file: /proc/self/mem}"),
            (f"{TGA}: /proc/self/mem: the file cannot be read (Input/output error)",),
        ),
        (
            "file outside the data base",
            study("{file: data/tga.csv}", "{file: 'macfp:UMET_TGA_N2_10K_1.csv'}"),
            ("unknown measured file 'UMET_TGA_N2_10K_1.csv'. Did you mean", "Known: "),
        ),
        (
            "folder of measured files missing",
            variable("PYROFIT_DATA_DIR", "nowhere"),
            ("PYROFIT_DATA_DIR=nowhere: this must be an existing folder", "`pyrofit data fetch`"),
        ),
        (
            "folder of measured files is a file",
            variable("PYROFIT_DATA_DIR", "study.yaml"),
            ("PYROFIT_DATA_DIR=study.yaml: this must be an existing folder", "Correct the path"),
        ),
        (
            "folder of measured files incomplete",
            variable("PYROFIT_DATA_DIR", "data"),
            (f"{TGA}: data/{ABSENT}: the measured file is not there. Run `make data`",),
        ),
        (
            "measured file altered",
            altered_file,
            (f"macfp/{ABSENT}: SHA-256 is", "altered. Delete it"),
        ),
        (
            "window without points",
            put(imp__costs__RMSE__0__window_s=[5000, 6000]),
            (
                f"imp.costs.RMSE.0, on {MLR}: window 5000 to 6000 s: 0 points lie inside",
                "Move or widen the window",
            ),
        ),
        (
            "window without points in the kinetics",
            put(kinetics__cost__0__window_s=[5000, 6000]),
            (f"kinetics.cost.0, on {TGA}: window 5000 to 6000 s: 0 points",),
        ),
        (
            "bands of no uncertainty",
            put(imp__costs__RMSE__0__signal="back_temperature", imp__costs__RMSE__0__kind="BANDS"),
            ("imp.costs.RMSE.0, on experiments.slab_25.signals.back_temperature: ", "uncertainty"),
        ),
        (
            "option out of range",
            put(imp__costs__RANGE__0__options={"r": -1}),
            (
                "imp.costs.RANGE.0, on experiments.slab_25.signals.mlr: r = -1.0; it must be",
                "Correct",
            ),
        ),
    ],
)
PREPARE = rows_of(
    "prepare --study study.yaml",
    ("error: ",),
    [
        ("file missing at prepare", delete("data/mlr.csv"), (f"{MLR}: data/mlr.csv: there is no",)),
        ("bad row at prepare", tga("\n60,", "\nsoon,"), (f"{TGA}: data/tga.csv, line 4, column",)),
        (
            "window without points at prepare",
            put(imp__costs__RMSE__0__window_s=[5000, 6000]),
            (
                f"imp.costs.RMSE.0, on {MLR}: window 5000 to 6000 s: 0 points lie inside",
                "Move or widen the window",
            ),
        ),
        (
            "window without points of a synthetic record",
            put(
                experiments__slab_25__signals__mlr={"file": "synthetic", "every": 50},
                imp__costs__RMSE__0__window_s=[5000, 6000],
                synthetic={**SYNTHETIC, "accuracy": {"elements": 10, "tolerance": 1e-3}},
            ),
            (
                f"imp.costs.RMSE.0, on {MLR}: window 5000 to 6000 s: 0 points lie inside",
                "Move or widen the window",
            ),
        ),
    ],
)
