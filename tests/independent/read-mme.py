"""Reads a test in ISO-MME with an independent reader, and compares it with the CSV table of the same run.

python3 read-mme.py TEST.mme RUN.csv
"""

import csv
import sys

import pyisomme

test, table = sys.argv[1:]
channels = pyisomme.Isomme().read(test).channels
head, *rows = csv.reader(open(table))
assert len(channels) == len(head) - 1, (len(channels), head)

times = [float(row[0]) for row in rows]
compared = 0
for place, channel in enumerate(channels, start=1):
    data = channel.data
    assert len(data) == len(rows), (channel.code, len(data), len(rows))
    for found, expected in zip(data.index, times):
        assert abs(found - expected) < 1e-12, (channel.code, found, expected)
    # the last character gives the filter: 0 means no filter
    if not channel.code.endswith("0"):
        continue
    for found, row in zip(data.iloc[:, 0], rows):
        assert found == float(row[place]), (channel.code, found, row[place])
    compared += 1
assert compared > 5, compared
print(f"{len(channels)} channels of {len(rows)} samples are read; {compared} without a filter have every digit of the table")
