"""Texts in an archive: its contents, the commands of a new run, and files that are left out."""

COMMENT = """\
The study as it was run, with the changes of the command line. The files of its measurements are
in data/, those of its plugins in plugins/. README.txt explains how to run it in software/.
"""
README = """\
{title}

study.yaml         The study as it was run. The folder as_given/ has the original files.
data/              Measured files of the study.
plugins/           Effects, quantities and costs of the study, if it has any.
programs/          Templates and other inputs of external programs, if there are any. The programs
                   are not in the archive: results/provenance.json has their checksums.
results/           study.json (every key completed) and provenance.json (versions, seed, checksums
                   of all measured files). Histories and best sets of all searches, predictions,
                   tables, figures, report.html.
software/          The version of pyrofit that made the results: {version}, source fingerprint
                   {fingerprint}. The file {versions} has the versions of all packages.
ro-crate-metadata.json
                   The same for programs: a Workflow Run RO-Crate, profile 0.5.
SHA256SUMS         Checksums of all these files: sha256sum --check SHA256SUMS

{again}
    diff -r ../results/tables results/{name}/tables

On the same kind of machine the tables agree in every digit. On another kind most digits agree.
"""
AGAIN_LOCKED = """\
To run the study again you need Python 3.11 or newer and make:

    cd software
    make .venv/installed
    export PATH=$PWD/.venv/bin:$PATH
    pyrofit check ../study.yaml
    pyrofit run ../study.yaml"""
AGAIN = """\
To run the study again you need Python 3.11 or newer:

    cd software
    python3 -m venv .venv
    .venv/bin/pip install -r requirements.txt
    export PYTHONPATH=$PWD/src
    .venv/bin/python -m pyrofit run ../study.yaml"""
MACFP_FILES = """
{count} measured files are part of the MaCFP data base, commit {commit}. This archive does not
contain them or columns that repeat them: results/provenance.json has their checksums.
Before the run, `make data` fetches them into the user's cache, or PYROFIT_DATA_DIR names a folder
with these files.
"""
