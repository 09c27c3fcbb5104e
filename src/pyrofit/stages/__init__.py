"""The steps of a study: each reads files, calls the library, writes files."""
