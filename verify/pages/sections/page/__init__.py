"""The sections of the page, one in each file; see `verify.pages.sections.section`."""

from verify.discovery import Catalogue

FILES = Catalogue(__name__, __path__)
