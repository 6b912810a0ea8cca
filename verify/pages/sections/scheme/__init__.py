"""The sections of a scheme: a file each, found by itself; see `verify.pages.sections.section`."""

from verify.discovery import Catalogue

FILES = Catalogue(__name__, __path__)
