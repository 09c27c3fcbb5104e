"""Headers as programs of instruments and laboratories write them, with what stands below them.

Each entry: the program, the kind of test, the lines above the numbers, and what stands in each
column, by its unit (`COLUMNS` of `test_headers_of_instruments.py`). What the file does not tell
stands at the end: it must be asked for.
"""

from typing import NamedTuple


class Export(NamedTuple):
    """A file of an instrument."""

    program: str
    kind: str
    above: str
    columns: str
    separator: str = ","
    decimal: str = "."
    asked: tuple[str, ...] = ()


PROTEUS = (
    "#EXPORTTYPE:DATA ALL\n#FILE:a.ngb-ss3\n#FORMAT:NETZSCH5\n#FTYPE:ASCII\n#IDENTITY:a\n"
    "#DECIMAL:{}\n#SEPARATOR:{}\n#INSTRUMENT:NETZSCH STA 449F3\n#SAMPLE MASS /mg:6.0\n"
    "#EXO:-1\n#RANGE:27/627/10.0(K/min)\n\n"
)
EXPORTS = [
    Export(
        "Proteus, TG-DSC",
        "tga",
        PROTEUS.format("POINT", "COMMA")
        + "##Temp./°C,Time/min,DSC/(mW/mg),Mass/%,Gas Flow(purge2)/(ml/min),Sensit./(uV/mW)",
        "C min W/g % flow x",
    ),
    Export(
        "Proteus, segments",
        "tga",
        PROTEUS.format("COMMA", "SEMICOLON") + "##Temp./°C;Time/min;TG/%;DTG/(%/min);Segment",
        "C min % x one",
        ";",
        ",",
    ),
    Export(
        "Proteus, German",
        "tga",
        PROTEUS.format("COMMA", "SEMICOLON") + "##Temp./°C;Zeit/min;Masse/%;Segment",
        "C min % one",
        ";",
        ",",
    ),
    Export(
        "Proteus, mass in mg",
        "tga",
        PROTEUS.format("POINT", "TAB") + "##Temp./°C\tTime/min\tMass/mg\tSegment",
        "C min mg one",
        "\t",
    ),
    Export(
        "TRIOS, step",
        "tga",
        "Filename\ta.tri\nInstrument\tTGA5500\n\n[step]\n"
        "Ramp 10.00 °C/min\nTime\tTemperature\tWeight\tWeight\nmin\t°C\tmg\t%",
        "min C mg %",
        "\t",
    ),
    Export(
        "TRIOS, CSV",
        "tga",
        "Time (min),Temperature (°C),Weight (mg),Deriv. Weight (%/°C)",
        "min C mg x",
    ),
    Export(
        "TRIOS, uncorrected",
        "tga",
        "Time,Temperature,Weight (Uncorrected)\n(min),(°C),(mg)",
        "min C mg",
    ),
    Export(
        "Universal Analysis",
        "tga",
        "CLOSED\t0\nInstrument\tTGA Q50\nSize\t6.0000\tmg\nNsig\t3\n"
        "Sig1\tTime (min)\nSig2\tTemperature (°C)\nSig3\tWeight (mg)\nOrgFile\ta.001\nStartOfData",
        "min C mg",
        "\t",
    ),
    Export(
        "STARe",
        "tga",
        "Curve Name:\n  TGA\nCurve Values:\n  Index  t  Ts  Tr  Value\n  "
        "       [s]  [°C]  [°C]  [mg]",
        "x s C Cf mg",
        "  ",
    ),
    Export("STARe, mean", "tga", "Index;t [s];Ts [°C];Tr [°C];Value [mg]", "x s C Cf mg", ";"),
    Export(
        "Pyris",
        "tga",
        "1) TGA\n\nTime\tUnsubtracted Weight\tBaseline Weight\tProgram Temperature"
        "\tSample Temperature\n(min)\t(mg)\t(mg)\t(°C)\t(°C)",
        "min mg zero Cf C",
        "\t",
    ),
    Export(
        "Calisto",
        "tga",
        "Time (s);Furnace Temperature (°C);Sample Temperature (°C);TG (mg);HeatFlow (mW)",
        "s Cf C mg x",
        ";",
    ),
    Export(
        "Calisto, French",
        "tga",
        "Temps (s);Température four (°C);Température échantillon (°C);TG (mg);Flux de chaleur (mW)",
        "s Cf C mg x",
        ";",
        ",",
    ),
    Export(
        "TA-60WS",
        "tga",
        "[File Name]\ta.tad\n[Data]\nTime\tTemp\tTGA\n[sec]\t[C]\t[mg]",
        "s C mg",
        "\t",
    ),
    Export(
        "Muse", "tga", "Sample Weight:,6.000,mg\n\nTime,Temp,DTA,TG\nmin,Cel,uV,ug", "min C x ug"
    ),
    Export("Muse, blanks", "tga", "Time/min  Temp/Cel  TG/ug  DTG/ug/min", "min C ug x", "  "),
    Export("Muse, percent", "tga", "Time(min),Temp.(Cel),TG(%),DTG(ug/min)", "min C % x"),
    Export("Rigaku", "tga", "Time[min],Temp.[C],TG[mg],DTA[uV]", "min C mg x"),
    Export("Linseis", "tga", "Zeit [s];Probentemperatur [°C];Abs. Masse [mg]", "s C mg", ";", ","),
    Export(
        "Linseis, English",
        "tga",
        "Time [s];Temp. sample [°C];Temp. furnace [°C];TG [mg]",
        "s C Cf mg",
        ";",
    ),
    Export("thermobalance of a university", "tga", "t_min;T_C;m_mg", "min C mg", ";"),
    Export("data logger", "tga", "Elapsed Time (s),Sample Temp (deg C),Balance (mg)", "s C mg"),
    Export("spreadsheet", "tga", "time, s;temperature, °C;weight, %", "s C %", ";"),
    Export("spreadsheet of names", "tga", "Time sec,T sample °C,Mass mg", "s C mg"),
    Export("Origin", "tga", "Temperature\tTG\n°C\t%", "C %", "\t", asked=("heating rate",)),
    Export("normalised", "tga", "T (K),m/m0 (-),t (s)", "K 1 s"),
    Export("conversion", "tga", "t (s),T (K),alpha (-)", "s K x", asked=("value",)),
    Export("residual weight", "tga", "Time (s),Temperature (K),Residual mass (%)", "s K %"),
    Export("TG relative", "tga", "Time (min),Temperature (C),Relative weight (wt.%)", "min C %"),
    Export("unit of Fahrenheit", "tga", "Time (min),Temperature (°F),Weight (%)", "min F %"),
    Export("Portuguese", "tga", "Tempo (min);Temperatura (°C);Massa (%)", "min C %", ";", ","),
    Export("Polish", "tga", "Czas [s];Temperatura [°C];Masa [mg]", "s C mg", ";", ","),
    Export("hours", "tga", "Time (h),Temperature (K),Mass (g)", "h K g"),
    Export(
        "milliseconds", "tga", "Time (ms),Temperature (K),Mass (mg)", "ms K mg", asked=("time",)
    ),
    Export(
        "DSC, Proteus",
        "dsc",
        PROTEUS.format("POINT", "COMMA") + "##Temp./°C,Time/min,DSC/(mW/mg)",
        "C min W/g",
    ),
    Export(
        "DSC, TRIOS", "dsc", "Time (min),Temperature (°C),Heat Flow (Normalized) (W/g)", "min C W/g"
    ),
    Export(
        "DSC, Q series",
        "dsc",
        "Size\t6.0000\tmg\nExotherm\tUp\nNsig\t3\nSig1\tTime (min)\n"
        "Sig2\tTemperature (°C)\nSig3\tHeat Flow (W/g)\nStartOfData",
        "min C -W/g",
        "\t",
    ),
    Export(
        "DSC, Pyris",
        "dsc",
        "Time\tUnsubtracted Heat Flow\tBaseline Heat Flow\tProgram Temperature"
        "\tSample Temperature\n(min)\t(W/g)\t(W/g)\t(°C)\t(°C)",
        "min W/g zero Cf C",
        "\t",
    ),
    Export("MCC, FAA", "mcc", "Time (s)\tTemperature (C)\tHRR (W/g)\tO2 (%)", "s C W/g x", "\t"),
    Export(
        "MCC, Deatak",
        "mcc",
        "Sample Mass (mg): 6.0\nHeating Rate (C/s): 1\n"
        "Time (s),Temperature (C),Heating Rate (C/s),Flow Rate (cc/min),Oxygen (%),HRR (W/g)",
        "s C x flow x W/g",
    ),
    Export("MCC, specific", "mcc", "time [s];temperature [°C];specific HRR [W/g]", "s C W/g", ";"),
    Export(
        "ConeCalc",
        "cone",
        "Time (s),HRR (kW/m²),MLR (g/s·m²),EHC (MJ/kg),SEA (m²/kg)",
        "s kW/m2 g/m2/s x x",
    ),
    Export(
        "ConeTools", "cone", "Time [s];RHR [kW/m2];MLR [g/m2s];SPR [m2/s]", "s kW/m2 g/m2/s x", ";"
    ),
    Export(
        "cone, ISO 5660", "cone", "t (s),q''A (kW/m2),m (g)", "s x g", asked=("sample_area_m2",)
    ),
    Export(
        "cone, dots",
        "cone",
        "Time (s),HRRPUA (kW/m2),Specimen mass (g),Duct temperature (K)",
        "s kW/m2 g x",
        asked=("sample_area_m2",),
    ),
    Export(
        "cone, total",
        "cone",
        "Time (s),HRR (kW/m2),THR (MJ/m2),Mass (g)",
        "s kW/m2 x g",
        asked=("sample_area_m2",),
    ),
    Export(
        "cone, German",
        "cone",
        "Zeit [s];HRR [kW/m²];Massenverlustrate [g/(m² s)]",
        "s kW/m2 g/m2/s",
        ";",
        ",",
    ),
    Export(
        "FPA", "gasification", "Time (s),Mass Loss Rate (g/s-m2),Chemical HRR (kW)", "s g/m2/s x"
    ),
    Export("gasification, symbols", "gasification", "t (s),m'' (kg/m2),T_back (K)", "s kg/m2 K"),
    Export(
        "gasification, MLR per sample",
        "gasification",
        "Time (s),Mass loss rate (g/s)",
        "s g/s",
        asked=("sample_area_m2",),
    ),
    Export(
        "gasification, thermocouples",
        "gasification",
        "Time (s),Mass (g),TC back 1 (K),TC back 2 (K)",
        "s g K K",
        asked=("sample_area_m2",),
    ),
    Export(
        "gasification, mg/cm2", "gasification", "Time (min);MLR (mg/cm²/min)", "min mg/cm2/min", ";"
    ),
    Export(
        "mass loss calorimeter",
        "gasification",
        "Time (s),Sample mass (g),Mass loss (%)",
        "s g x",
        asked=("sample_area_m2",),
    ),
    Export("Chinese", "tga", "时间 (min),温度 (°C),质量 (mg)", "min C mg"),
    Export("Dutch", "tga", "Tijd (s);Temperatuur monster (°C);Massa (mg)", "s C mg", ";", ","),
    Export(
        "two furnaces",
        "tga",
        "Time (s),Temperature 1 (K),Temperature 2 (K),Mass (mg)",
        "s K Cf mg",
        asked=("temperature",),
    ),
    Export(
        "temperature in two units",
        "tga",
        "Time (s),Temperature (C),Temperature (K),Residual_Sample_Mass (mg)",
        "s C K mg",
    ),
    Export("nothing but numbers in percent", "tga", "Time (s),Temperature (K),Signal (%)", "s K %"),
    Export(
        "no units",
        "tga",
        "Time,Temperature,Mass",
        "min C %",
        asked=("time", "temperature", "value"),
    ),
    Export(
        "voltage", "tga", "Time (s),Temperature (mV),Mass (mg)", "s x mg", asked=("temperature",)
    ),
    Export(
        "mass in per mille",
        "tga",
        "Time (s),Temperature (K),Mass (permille)",
        "s K x",
        asked=("value",),
    ),
    Export(
        "TRIOS, parameters",
        "tga",
        "[File Parameters]\nInstrument Type\tTGA\nSample Mass\t6.0 mg\n\n[step]\n"
        "Ramp 10.00 °C/min\nTime\tTemperature\tWeight\tDeriv. Weight\tSample Purge Flow\n"
        "min\t°C\t%\t%/min\tmL/min",
        "min C % x flow",
        "\t",
    ),
    Export(
        "Pyris, approximate flow",
        "tga",
        "Sample Weight:\t6.000 mg\nTime\tWeight\tWeight %\tProgram Temperature\tSample Temperature"
        "\tApprox. Gas Flow\nmin\tmg\t%\tC\tC\tml/min",
        "min mg % Cf C flow",
        "\t",
    ),
    Export(
        "NEXTA",
        "tga",
        "Sample Weight\t6.000\tmg\nModule\tSTA200RV\n\n"
        "Time(min)\tTemp.(°C)\tTG(mg)\tDTA(uV)\tDTG(mg/min)",
        "min C mg x x",
        "\t",
    ),
    Export(
        "Proteus, change of mass",
        "tga",
        PROTEUS.format("COMMA", "SEMICOLON") + "##Temp./°C;Zeit/min;Massenänderung/%",
        "C min -%",
        ";",
        ",",
    ),
    Export(
        "ThermoPlus, change of mass",
        "tga",
        "Sample Wt.(mg),6.000\nTime(sec),Temperature(C),TG(mg),DTA(uV)",
        "s C -mg x",
    ),
    Export(
        "Linseis, Delta M",
        "tga",
        "Sample mass: 6.0 mg\nTime [min];Temperature [°C];Delta M [mg]",
        "min C -mg",
        ";",
    ),
    Export(
        "thermobalance with a crucible",
        "tga",
        "Elapsed Time (s),Furnace Temp (C),Crucible Weight (g)",
        "s C g",
        asked=("value",),
    ),
    Export(
        "Themys, other zero",
        "tga",
        "TG : Initial Mass : 6.00 mg\nTime (s)\tFurnace Temperature (°C)\tSample Temperature (°C)"
        "\tTG (mg)\tHeatFlow (mW)",
        "s Cf C +mg x",
        "\t",
    ),
    Export("Bähr", "tga", "t/s;T/°C;TG/mg;DTA/µV", "s C mg x", ";", ","),
    Export("IUPAC", "tga", "t / min,T / K,m / mg", "min K mg"),
    Export("Japanese", "tga", "時間(min),温度(℃),重量(mg)", "min C mg"),
    Export("Russian", "tga", "Время, мин;Температура, °C;Масса, %", "min C %", ";", ","),
    Export("commas in names", "tga", "Time, s;Temp., °C;Mass, %", "s C %", ";", ","),
    Export("quoted names", "tga", '"Time, t (min)","Temperature, T (°C)","Mass, m (%)"', "min C %"),
    Export("units in words", "tga", "t in s;T in °C;m/m0 in %", "s C %", ";", ","),
    Export(
        "weight percent",
        "tga",
        "Time (sec)\tSample Temp (°C)\tWeight Percent (%)\tDerivative Weight Percent (%/min)",
        "s C % x",
        "\t",
    ),
    Export("degrees F", "tga", "Time (s),Temp (F),Mass (%)", "s F %"),
    Export("STARe, DSC", "dsc", "Index,t,Ts,Tr,Value\n,[s],[°C],[°C],[Wg^-1]", "x s C Cf W/g"),
    Export(
        "Pyris, endo up",
        "dsc",
        "Sample Weight: 6.000 mg\nTime (min)\tHeat Flow Endo Up (mW)\tTemperature (°C)",
        "min mW C",
        "\t",
    ),
    Export(
        "DSC-60",
        "dsc",
        "[Sample Weight]\t6.000[mg]\n[Data]\nTime\tTemp\tDSC\n[sec]\t[C]\t[mW]",
        "s C mW",
        "\t",
    ),
    Export(
        "modulated DSC",
        "dsc",
        "Time (min),Temperature (°C),Heat Flow (W/g),Rev Heat Flow (W/g),Nonrev Heat Flow (W/g)",
        "min C W/g one one",
    ),
    Export(
        "MCC, FTT",
        "mcc",
        "Sample mass (mg),6\n"
        "Time (s),Temperature (°C),O2 (%),Flow Rate (ml/min),Specific HRR (W/g)",
        "s C x flow W/g",
    ),
    Export("MCC, symbols", "mcc", "Time(s)\tT_sample(C)\tO2(%)\tQ(W/g)", "s C x W/g", "\t"),
    Export(
        "iCone",
        "cone",
        "Heat flux (kW/m2),50\nTime (s),HRRPUA (kW/m2),THRPUA (MJ/m2),MLRPUA (g/m2.s),EHC (MJ/kg)",
        "s kW/m2 x g/m2/s x",
    ),
    Export(
        "cone, Zeit",
        "cone",
        "Zeit (s);Wärmefreisetzungsrate (kW/m²);Massenverlustrate (g/m²s)",
        "s kW/m2 g/m2/s",
        ";",
        ",",
    ),
    Export(
        "FPA, derivative",
        "gasification",
        "Time(sec),Mass(g),dm/dt(g/s),Back Temp (C)",
        "s g g/s C",
        asked=("sample_area_m2",),
    ),
    Export("mass flux", "gasification", "Time [s],Mass flux [g/s-m2],T_bot [K]", "s g/m2/s K"),
    Export(
        "CAPA",
        "gasification",
        "Time (s)\tMass Loss Rate (kg/m^2*s)\tBack surface temperature (K)",
        "s kg/m2/s K",
        "\t",
    ),
    Export(
        "balance of ash",
        "tga",
        "Analysis Time,Temperature,Mass\nsec,C,g",
        "s C g",
    ),
    Export("logger, units alone", "tga", "Elapsed (s)\tT_sample (degC)\tMass_mg", "s C mg", "\t"),
    Export(
        "Setsys, corrected",
        "tga",
        "Initial mass : 6.00 mg\n"
        "Time (s)\tSample Temperature (°C)\tTG corrected (mg)\tdTG (mg/min)",
        "s C -mg x",
        "\t",
    ),
    Export("script", "tga", "t_s,T_K,m_rel", "s K 1", asked=("value",)),
    Export("Korean", "tga", "시간 (min),온도 (°C),질량 (mg)", "min C mg"),
    Export("Swedish", "tga", "Tid (s);Temp (°C);Massa (mg)", "s C mg", ";", ","),
    Export("Finnish", "tga", "Aika (s);Lämpötila (°C);Massa (mg)", "s C mg", ";", ","),
    Export(
        "SII, number of the row",
        "tga",
        "No.,Time[min],Temp[Cel],DTA[uV],TG[ug]",
        "x min C x ug",
    ),
    Export("STARe, arrow", "dsc", "^exo\nt [s];Ts [°C];Tr [°C];Value [W/g]", "s C Cf -W/g", ";"),
    Export(
        "TRIOS, DSC",
        "dsc",
        "Sample Mass\t6.0 mg\nExotherm\tDown\n\n[step]\n"
        "Time\tTemperature\tHeat Flow (Normalized)\nmin\t°C\tW/g",
        "min C W/g",
        "\t",
    ),
    Export(
        "cone, dotted units",
        "cone",
        "Time (s),Heat Release Rate (kW/m2),Mass Loss Rate (g/s.m2),CO (kg/kg)",
        "s kW/m2 g/m2/s x",
    ),
    Export("cone, symbols", "cone", "time_s,qdot_kW_m2,mdot_g_m2s", "s kW/m2 g/m2/s"),
    Export(
        "gasification, dashed unit",
        "gasification",
        "time (sec),mass loss rate (g/m^2-s),back face temp (K)",
        "s g/m2/s K",
    ),
]
