#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-or-later
# Killed at random moments on 2 and 3 ranks of 2 threads each, and gone on with on another number of ranks:
# the tables are those of a run that nobody killed, byte for byte. Journals whose records stand in another
# order, twice, damaged, or are of another program.
# Usage: resume.sh FLANK ROOT [KILLS]      60 kills, or FLANK_KILLS
source "$(dirname "$0")/shell.sh"
kills=${3:-${FLANK_KILLS:-60}}
export FLANK_THREADS=2
case=(run "$root/cases/parallel_axis/helical.toml" --accuracy draft --set mesh_cycle.positions=96
  --set mesh.face_layers=4 --set contact_grid.slices=9 --set 'load.pinion_torque_Nm=[0,50,100,300]')
"$flank" "${case[@]}" -o whole >/dev/null 2>&1 || fail "the run to compare with"
tables() {
  cat "$1"/te.csv "$1"/harmonics.csv "$1"/pairs.csv "$1"/lines.csv "$1"/pattern.csv | cksum
  /usr/bin/python3 "$root/tests/cases/h5_contents.py" "$1/results.h5"
}
expected=$(tables whole)
complete() { [[ $(tables killed) == "$expected" && ! -e killed/unfinished ]] || fail "$1"; rm -rf killed; }

killed=0 finished=0 resumed=0
while [[ $killed -lt $kills ]]; do
  ranks=$((2 + killed % 2))
  setsid mpirun --oversubscribe -n $ranks "$flank" "${case[@]}" -o killed --resume >screen 2>message & pid=$!
  # Half of the kills soon after the first new record, the others anywhere.
  if [[ $((RANDOM % 2)) -eq 0 ]]; then
    for _ in $(seq 200); do
      grep -q "contact: [0-9]* of" message 2>/dev/null && break
      kill -0 $pid 2>/dev/null || break
      sleep 0.01
    done
    sleep 0.0$((RANDOM % 10))
  else
    sleep 0.$((RANDOM % 10))$((RANDOM % 10))
  fi
  pkill -9 -s $pid; wait $pid 2>/dev/null
  code=$?
  killed=$((killed + 1))
  grep -q "going on" message && resumed=$((resumed + 1))
  if [[ $code -eq 0 ]]; then finished=$((finished + 1)); complete "finished after kills: other tables"; fi
  [[ $code -eq 0 || $code -eq 137 || $code -eq 9 ]] ||
    { cat message; fail "going on after a kill: exit code $code"; }
  if [[ $((killed % 10)) -eq 0 && -e killed ]]; then
    ranks=$((1 + killed % 3))
    mpirun --oversubscribe -n $ranks "$flank" "${case[@]}" -o killed --resume >/dev/null 2>message ||
      { cat message; fail "going on"; }
    complete "gone on with after $killed kills: other tables"
  fi
done
[[ $((10 * resumed)) -ge $kills ]] ||
  fail "the kills came too early to test anything ($resumed of $kills found records)"

# One journal of a killed run, and what can happen to it.
journal() { # waits for some records, kills
  rm -rf killed; setsid "$flank" "${case[@]}" -o killed >/dev/null 2>message & pid=$!
  for _ in $(seq 500); do grep -q "contact: [2-9][0-9] of" message 2>/dev/null && break; sleep 0.01; done
  kill -9 $pid; wait $pid 2>/dev/null
  [[ -s killed/unfinished/positions-0-1.journal ]] || journal
}
# A program that finds no libraries is not the case's fault: what was finished stays.
journal
mkdir -p alone && cp "$flank" alone/flank
cp killed/unfinished/positions-0-1.journal before
FLANK_CACHE=$work/no_cache alone/flank "${case[@]}" -o killed --resume >/dev/null 2>message
[[ $? -eq 3 && $(wc -l <message) -ge 1 ]] && tail -1 message | grep -q "cannot be loaded.*--resume" ||
  { cat message; fail "a program without its libraries"; }
cat killed/unfinished/*.journal | head -c "$(stat -c %s before)" | cmp - before ||
  fail "a program without its libraries loses finished positions"

goes_on() {
  "$flank" "${case[@]}" -o killed --resume >/dev/null 2>message || { cat message; fail "$1"; }
  complete "$1: other tables"
}
journal
cp -r killed kept
/usr/bin/python3 - kept/unfinished/positions-0-1.journal <<'END' || fail "the journal's records"
import random, struct, sys
# Records: magic 8, name bytes 8, content bytes 8, two checksums of 4, name, content. The first one is the
# key, whose checksum the others' go on from.
data = open(sys.argv[1], "rb").read()
records, at = [], 0
while at + 32 <= len(data):
    name, content = struct.unpack_from("<QQ", data, at + 8)
    if data[at:at + 8] != b"FLANKJN3" or at + 32 + name + content > len(data):
        break
    records.append(data[at:at + 32 + name + content])
    at += 32 + name + content
assert len(records) > 10, len(records)
key, rest = records[0], records[1:]
random.seed(1)
def write(name, parts):
    open(name, "wb").write(b"".join(parts))
shuffled = rest[:]
random.shuffle(shuffled)
write("shuffled", [key] + shuffled)
write("doubled", [key] + rest + shuffled)
write("hole", [key] + rest[:5] + [b"\0" * len(rest[5])] + rest[6:])
same = next((i, j) for i in range(len(rest)) for j in range(i) if len(rest[i]) == len(rest[j]))
def with_content_of(record, other):  # its own name and checksums
    name = struct.unpack_from("<Q", record, 8)[0]
    return record[:32 + name] + other[32 + name:]
i, j = same
exchanged = rest[:]
exchanged[i], exchanged[j] = with_content_of(rest[i], rest[j]), with_content_of(rest[j], rest[i])
write("exchanged", [key] + exchanged)
import zlib
# Right checksums, another's content: what a program of another layout might have left.
def named(record, other, belongs_to=zlib.crc32(key[32 + 3:])):
    name = struct.unpack_from("<Q", record, 8)[0]
    body = record[32:32 + name] + other[32 + struct.unpack_from("<Q", other, 8)[0]:]
    head = b"FLANKJN3" + struct.pack("<QQ", name, len(body) - name)
    return head + struct.pack("<II", zlib.crc32(head), zlib.crc32(body, belongs_to)) + body
write("foreign", [key] + [named(rest[k], rest[(k + 7) % len(rest)]) for k in range(len(rest))])
def filled(record, byte):  # right checksums, all of the content one byte
    head = 32 + struct.unpack_from("<Q", record, 8)[0]
    return named(record, record[:head] + byte * (len(record) - head))
write("zeros", [key] + [filled(r, b"\0") for r in rest])
write("ones", [key] + [filled(r, b"\xff") for r in rest])
other = named(key, key[:32 + 3] + key[32 + 3:].replace(b"sources ", b"sources of another program "), 0)
write("program", [other] + rest)
# A journal of other inputs at the end of this one's: its pieces have the same names, and another key.
of_other = zlib.crc32(other[32 + 3:])
write("joined", [key] + rest[:5] + [other] + [named(rest[k], rest[(k + 7) % len(rest)], of_other)
                                              for k in range(len(rest))])
END
for kind in joined shuffled doubled hole exchanged foreign zeros ones; do
  rm -rf killed; cp -r kept killed; cp $kind killed/unfinished/positions-0-1.journal
  goes_on "a journal that is $kind"
done
rm -rf killed; cp -r kept killed; cp doubled killed/unfinished/positions-1-1.journal
mpirun --oversubscribe -n 3 "$flank" "${case[@]}" -o killed --resume >/dev/null 2>message ||
  { cat message; fail "two journals on three ranks"; }
complete "two journals on three ranks: other tables"
rm -rf killed; cp -r kept killed; cp program killed/unfinished/positions-0-1.journal
"$flank" "${case[@]}" -o killed --resume >/dev/null 2>message
[[ $? -eq 2 ]] && grep -q "sources of another program" message ||
  { cat message; fail "a journal of another program"; }
for cut in 0 1 31 40 5000; do
  rm -rf killed; cp -r kept killed
  truncate -s -$cut killed/unfinished/positions-0-1.journal
  goes_on "a journal cut by $cut bytes"
  rm -rf killed; cp -r kept killed
  truncate -s $cut killed/unfinished/positions-0-1.journal
  goes_on "a journal cut to $cut bytes"
done
# A drive of many crank angles, killed twice on other numbers of ranks: every angle that was finished is kept.
drive=(run "$root/cases/double_roller/exact.toml" --set mesh_cycle.crank_angles_deg.step=0.1)
drive_tables() {
  cat "$1"/*.csv | cksum
  /usr/bin/python3 "$root/tests/cases/h5_contents.py" "$1/results.h5"
  grep '^certificate' "$1/summary.txt"
}
"$flank" "${drive[@]}" -o whole_drive >/dev/null 2>&1 || fail "the drive to compare with"
for ranks in 1 2; do
  : >message # what the run before it said must not be taken for its own
  setsid mpirun --oversubscribe -n $ranks "$flank" "${drive[@]}" -o killed_drive --resume >screen 2>message &
  pid=$!
  until grep -q "load balance: crank angle" message; do
    kill -0 $pid 2>/dev/null || fail "the drive on $ranks ranks ended before it was killed"; sleep 0.01
  done
  pkill -9 -s $pid; wait $pid 2>/dev/null
  [[ $ranks -eq 1 ]] || grep -q "going on: [1-9][0-9]* piece" message ||
    { cat message; fail "a drive killed once"; }
  ! grep -q "no such result" message || { cat message; fail "a drive's records"; }
done
cp -r killed_drive kept_drive
mpirun --oversubscribe -n 3 "$flank" "${drive[@]}" -o killed_drive --resume >screen 2>message &&
  grep -q "going on: [1-9][0-9][0-9]* pieces" message && ! grep -q "no such result" message ||
  { cat message; fail "a drive killed twice"; }
[[ $(drive_tables killed_drive) == "$(drive_tables whole_drive)" && ! -e killed_drive/unfinished ]] ||
  fail "a drive killed twice: other tables"
# Right checksums, another piece's content, zeros, a content cut short, or a number that no study has.
cat >records.py <<'END'
import struct, sys, zlib
def written(magic, name, content, start):
    head = magic + struct.pack("<QQ", len(name), len(content))
    return head + struct.pack("<II", zlib.crc32(head), zlib.crc32(name + content, start)) + name + content
def huge(content):  # lists of variants and positions, no failure, and points: the first one's response
    variants = struct.unpack_from("<q", content)[0]
    positions = struct.unpack_from("<q", content, 8 + 8 * variants)[0]
    at = 8 + 8 * variants + 8 + 4 * positions + 16
    return content[:at] + struct.pack("<d", 1e300) + content[at + 8:]
change = {"foreign": lambda content, other: other,
          "zeros": lambda content, other: b"\0" * len(content),
          "short": lambda content, other: content[:-8],
          "huge": lambda content, other: huge(content)}[sys.argv[1]]
for path in sys.argv[2:]:
    data, records = open(path, "rb").read(), []
    while len(data) >= 32:
        name, content = (32 + size for size in struct.unpack_from("<QQ", data, 8))
        records.append((data[:8], data[32:name], data[name:name + content - 32]))
        data = data[name + content - 32:]
    key, *rest = records
    before = open(path, "rb").read()
    # Checksums go on from the key's, or do not.
    start = next(start for start in (zlib.crc32(key[2]), 0) if written(*rest[0], start) in before)
    with open(path, "wb") as file:
        file.write(written(*key, 0))
        for (magic, name, content), other in zip(rest, rest[1:] + rest[:1]):
            file.write(written(magic, name, change(content, other[2]), start))
END
for kind in foreign zeros short; do
  rm -rf killed_drive; cp -r kept_drive killed_drive
  /usr/bin/python3 records.py $kind killed_drive/unfinished/*.journal || fail "the drive's records"
  "$flank" "${drive[@]}" -o killed_drive --resume >screen 2>message && grep -q "no such result" message &&
    [[ $(drive_tables killed_drive) == "$(drive_tables whole_drive)" ]] ||
    { grep -v "no such result" message; fail "a drive's journal that is $kind"; }
done
# A study: half of it is there, and is read once more when its tables are made; then again after a kill.
cat "$root/cases/parallel_axis/helical.toml" - >study.toml <<<$'[[study]]\nset = "pinion.lead_crown.amount_um"
values = [1, 2, 3, 4]'
study=(study study.toml --accuracy draft --set mesh_cycle.positions=4 --set contact_grid.slices=9
  --set 'load.pinion_torque_Nm=[50]' --set output.error_estimate=no)
"$flank" "${study[@]}" -o whole_study >/dev/null 2>&1 || fail "the study to compare with"
"$flank" "${study[@]}" -o kept_study --part 1/2 >/dev/null 2>&1 || fail "half of a study"
for kind in foreign zeros short huge; do
  rm -rf half_study; cp -r kept_study half_study
  /usr/bin/python3 records.py $kind half_study/unfinished/*.journal || fail "the study's records"
  "$flank" "${study[@]}" -o half_study --part 1/2 >/dev/null 2>message && grep -q "no such result" message ||
    { cat message; fail "half of a study whose journal is $kind"; }
  "$flank" "${study[@]}" -o half_study --resume >screen 2>message && grep -q "no such result" message ||
    { cat message; fail "a study's journal that is $kind"; }
  for table in te.csv designs.csv; do
    cmp half_study/$table whole_study/$table || fail "a study's journal that is $kind: $table"
  done
done
echo "$killed kills, $finished came after the end, $resumed found records; 0 lost"
echo "1 passed, 0 failed"
