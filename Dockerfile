# pyrofit with the locked versions of all packages. docs/cluster.md says how it is used.
#     docker build --tag pyrofit .
# The environment is made by the Makefile, as without a container.
FROM python:3.11-slim-bookworm
RUN apt-get update \
    && apt-get install --yes --no-install-recommends make \
    && rm -rf /var/lib/apt/lists/*
WORKDIR /opt/pyrofit
COPY Makefile requirements.lock pyproject.toml README.md LICENSE CITATION.cff Snakefile ./
COPY src src
COPY workflow workflow
COPY profiles profiles
COPY config config
RUN make .venv/installed
ENV PATH=/opt/pyrofit/.venv/bin:$PATH
CMD ["pyrofit", "doctor"]
