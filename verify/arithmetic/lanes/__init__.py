"""Four or eight numbers at once, one in each lane of the vector unit: ensembles of orbits.

A lane has the bits that a kernel of one orbit has, whatever the other lanes hold.
"""
