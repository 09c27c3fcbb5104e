"""Headers in other languages, French and German first, in the English words of a new study."""

import re
import unicodedata

_SAMPLE = r"(de?l?a?)?(l?echantillon|muestra|campione|amostra|probe|proben?)"
_MASS = r"(masse|masa|massa|poids|peso|gewicht)"
_OF = r"(dela|del|de|du|des|di|da)?"
_WORDS = (
    (r"(temps|tempo|tiempo)(ecoule|total|deltest)?|czas|tijd|时间|時間|시간|время", "time"),
    (r"(versuchs|mess|lauf)?zeit", "time"),
    (rf"temperatur[ae]?{_SAMPLE}|probentemp(eratur)?", "sample temperature"),
    (rf"temperatur[ae]?{_OF}(four|horno|forno|ofen)|ofentemp(eratur)?", "furnace temperature"),
    (
        rf"temperatur[ae]?{_OF}(face|cara|faccia)?(arriere|dos|posterior[e]?|trasera|ruckseite)"
        r"|(probe(n)?)?ruck(seiten|wand)?temp(eratur)?|ruckseite",
        "back temperature",
    ),
    (
        rf"temperatur[ae]?{_OF}(la)?(surface|faceavant|superficie|oberflache)"
        r"|(proben?)?(oberflachen|vorderseiten)temp(eratur)?",
        "front temperature",
    ),
    (r"temperatur[ae]?|温度|온도|температура(образца)?", "temperature"),
    (
        rf"(vitesse|taux|debit|velocidad|tasa|velocita){_OF}(perte|perdida|perdita){_OF}{_MASS}"
        r"|mass(en?)?verlust(rate|geschwindigkeit)|mlr",
        "mass loss rate",
    ),
    (
        rf"(perte|perdida|perdita){_OF}{_MASS}|(mass(en?)?|gewichts)(verlust|abnahme)",
        "mass loss",
    ),
    (
        rf"m/m(o|i|init|initial)?|(fraction|fraccion|frazione|frac){_OF}(massique|masica|massica|{_MASS})"
        rf"|mass(en?)?anteil|{_MASS}(relative?|relativ[ao]|normalisee?)|rel(ative)?masse",
        "mass fraction",
    ),
    (
        rf"(rest|proben|abs)?{_MASS}({_SAMPLE}|residuelle|restante|residu[ao]l?)?|质量|重量|質量|질량"
        r"|масса|тг",
        "mass",
    ),
    (
        rf"(debit|puissance|taux){_OF}(calorifique|chaleur|degage(e|ment)?|degagementdechaleur)"
        r"|(warme|energie)freisetzungs?rate|tasadeliberaciondecalor|potenzatermica|rhr",
        "heat release rate",
    ),
    (
        rf"(flux|flujo|flusso){_OF}(chaleur|thermique|calor|calore|termico|calorifique)"
        r"|warme(strom|fluss)(dichte)?",
        "heat flow",
    ),
)
"""Pattern of a whole header, without accents, blanks and unit; its English words."""


def english(stem: str) -> str:
    """Return the stem of a header in English, a numeral at its end kept.

    >>> english("températureéchantillon"), english("masse2"), english("débitcalorifique")
    ('sampletemperature', 'mass2', 'heatreleaserate')
    >>> english("temps"), english("temp"), english("masseverlust"), english("tc1")
    ('time', 'temp', 'massloss', 'tc1')
    """
    plain = "".join(c for c in unicodedata.normalize("NFKD", stem) if not unicodedata.combining(c))
    plain = unicodedata.normalize("NFC", plain)  # letters of Korean are one sign again
    plain, number = re.fullmatch(r"(.*?)(\d*)", re.sub(r"['’]", "", plain)).groups()  # type: ignore[union-attr]
    for pattern, words in _WORDS:
        if re.fullmatch(pattern, plain):
            return words.replace(" ", "") + number
    return stem
