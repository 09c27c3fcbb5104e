"""Texts that an archive holds: how it is run again, and what it leaves out."""

COMMENT = """\
The study as it was run, with the changes of the command line. The files of its measurements are
in data/, those of its plugins in plugins/. It runs in the folder software/; README.txt says how.
"""
README = """\
{title}

study.yaml         the study as it was run; as_given/ has the files it came from
data/              measured files of its own
plugins/           effects, quantities, costs of its own, if it has any
programs/          templates and other files that external programs are given, if there are any; the
                   programs themselves are not here: results/provenance.json has their checksums
results/           study.json (every key completed), provenance.json (versions, seed, checksums of
                   all measured files), histories and best sets of all searches, predictions,
                   tables, figures, report.html
software/          pyrofit {version} as it made the results, source fingerprint {fingerprint},
                   and requirements.lock with the exact versions of all packages
ro-crate-metadata.json
                   the same for programs: a Workflow Run RO-Crate, profile 0.5
SHA256SUMS         checksums of all these files: sha256sum --check SHA256SUMS

To run it again you need Python 3.11 or newer and make:

    cd software
    make .venv/installed
    export PATH=$PWD/.venv/bin:$PATH
    pyrofit check ../study.yaml
    snakemake --cores 2 --configfile ../study.yaml
    diff -r ../results/tables results/{name}/tables

On the same kind of machine the tables agree in every digit, on another in most.
"""
MACFP_FILES = """
{count} measured files are of the MaCFP data base, commit {commit}. They are not
in this archive, nor are columns that repeat them: results/provenance.json has their checksums.
Before the study is run, `make data` fetches them into the user's cache, or PYROFIT_DATA_DIR names a
folder that has them.
"""
