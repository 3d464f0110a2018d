#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-or-later
# Result folders: what is somebody's own is never touched, old results stay until new ones are complete,
# one process at a time, and whatever is killed or cannot be written loses nothing that was finished.
source "$(dirname "$0")/shell.sh"
helical=$root/cases/parallel_axis/helical.toml
small=(--accuracy draft --set mesh_cycle.positions=4 --set contact_grid.slices=9
  --set mesh.face_layers=4
  --set 'load.pinion_torque_Nm=[100]')
marker="Unfinished results of Flank, format 1. This folder goes when they are complete; "
marker+="flank run or study with --resume goes on with it."
run() { "$flank" run "$helical" "${small[@]}" "$@"; }
refused() { # WORDS ARGUMENTS...: exit code 2, one line that says so
  local words=$1; shift
  run "$@" >screen 2>message; [[ $? -eq 2 ]] || fail "not refused: $*"
  [[ $(grep -vc '^plan: ' message) -eq 1 ]] && grep -q -- "$words" message ||
    { cat message; fail "how it is refused ($words): $*"; }
}
state() { (cd "$1" && find . -type f -exec cksum {} + | sort); }
same_state() { [[ $(state "$1") == "$2" ]] || fail "$3"; }

# Somebody's own files, under every name that results have, and under others.
run -o first >/dev/null 2>&1 || fail "run"
for name in te.csv results.h5 case.toml designs.csv report.html summary.txt manifest.txt unfinished \
    notes.partial thesis.txt; do
  rm -rf own; mkdir own; echo mine >own/$name; before=$(state own)
  refused "$name\|manifest" -o own
  same_state own "$before" "$name was touched"
  case $name in
    notes.partial | thesis.txt) run -o own --force >/dev/null 2>&1 || fail "beside $name, forced" ;;
    *) refused "$name\|manifest" -o own --force ;;
  esac
  [[ $(cat own/$name) == mine ]] || fail "$name was touched, forced"
done
rm -rf own; mkdir -p own/unfinished own/fields own/te.csv own/x.partial
for file in unfinished/a fields/b.vtu x.partial/c; do echo mine >own/$file; done
before=$(state own)
refused "not" -o own; refused "not" -o own --force
same_state own "$before" "folders of somebody's own were touched"
# Empty folders of somebody's own, under names that results have, stay.
rm -rf own; mkdir -p own/fields own/figures
run -o own --force >/dev/null 2>&1 && [[ -d own/fields && -d own/figures ]] ||
  fail "empty folders of one's own"
# A folder by a link to it, with a slash behind.
rm -rf own; mkdir own; ln -s own link
run -o link/ >/dev/null 2>&1 && [[ -e own/te.csv && ! -e own/unfinished ]] || fail "-o LINK/"
rm -r link own; ln -s own link
refused "is a link that leads nowhere" -o link
rm link
# The case itself in the folder: -o . with a run that fails, and with one that does not.
mkdir here; cp "$helical" here/case.toml; cp "$helical" here/mine.toml
too_much_here() { # CASE ARGUMENTS...
  (cd here && "$flank" run "$1" "${small[@]}" --set 'load.pinion_torque_Nm=[1e9]' -o . "${@:2}" \
    >/dev/null 2>&1)
}
too_much_here case.toml; [[ $? -eq 2 ]] || fail "-o . beside other files"
too_much_here mine.toml --force; [[ $? -eq 2 ]] || fail "-o . with a case.toml of one's own"
rm here/case.toml
too_much_here mine.toml --force; [[ $? -eq 3 ]] || fail "-o . with a run that fails"
cmp -s here/mine.toml "$helical" && [[ $(ls here) == mine.toml ]] ||
  fail "-o . with a run that fails leaves the case alone"
# A result as input; a result changed by hand; a link in its place.
cp -r first again
"$flank" run again/case.toml "${small[@]}" -o again >/dev/null 2>message
[[ $? -eq 2 ]] && grep -q "is a result in again" message || fail "an input that is a result"
echo "# seen" >>again/te.csv
refused "not as Flank wrote it" -o again
refused "not as Flank wrote it" -o again --force
rm again/te.csv; ln -s ../first/te.csv again/te.csv; before=$(cksum <first/te.csv)
refused "not as Flank wrote it" -o again --force
[[ $(cksum <first/te.csv) == "$before" ]] || fail "written through a link"
# Other inputs, other commands, the same again, nothing to do.
refused "other inputs.*lead_crown" -o first --set pinion.lead_crown.amount_um=7
cp first/te.csv te_of_first; rm first/te.csv
run -o first --resume >screen 2>message && grep -q "first/te.csv is gone" message &&
  cmp first/te.csv te_of_first ||
  fail "finished results of which a table is gone"
before=$(state first)
run -o first --resume >screen 2>/dev/null && grep -q "nothing to do" screen ||
  fail "--resume of what is finished"
same_state first "$before" "--resume of what is finished changed it"
cp first/te.csv before.csv
run -o first >/dev/null 2>&1 && cmp before.csv first/te.csv || fail "the same again is the same"
before=$(state first)
run -o first --force --set pinion.lead_crown.amount_um=7 >/dev/null 2>&1 &&
  [[ $(state first) != "$before" ]] || fail "--force replaces results"
grep -q "lead_crown.amount_um = 7" first/manifest.txt || fail "the manifest says what the results are of"
(cd first && sed -n '5,/^case:/p' manifest.txt | grep -v '^case:' |
  while read -r crc size name; do [[ $(stat -c %s "$name") -eq $size ]] || exit 1; done) ||
  fail "sizes in the manifest"
cat "$helical" - >study.toml <<<$'[[study]]\nset = "pinion.lead_crown.amount_um"\nvalues = [1, 2]'
"$flank" study study.toml "${small[@]}" -o first 2>message >/dev/null
[[ $? -eq 2 ]] && grep -q "flank run" message || fail "a study in a run's folder"
"$flank" study study.toml "${small[@]}" -o study >/dev/null 2>&1 || fail "study"
for again in --resume "--part 1/2"; do
  "$flank" study study.toml "${small[@]}" -o study $again >screen 2>/dev/null &&
    grep -q "nothing to do" screen || fail "$again of a finished study"
done
printf 'pinion.lead_crown.amount_um\n1\n' >study/mine.csv
cat "$helical" - >designs.toml <<<$'[[study]]\nfile = "designs.csv"'
mkdir axes; cp designs.toml axes/
printf 'pinion.lead_crown.amount_um\n1\n2\n' >axes/designs.csv
before=$(state axes)
(cd axes && "$flank" study designs.toml "${small[@]}" -o . --force >/dev/null 2>../message; [[ $? -eq 2 ]]) &&
  same_state axes "$before" "a study's own axis file was overwritten" ||
  fail "a study whose axis file has a result's name"

# A run that fails leaves old results as they are.
run -o old >/dev/null 2>&1; before=$(state old)
run -o old --force --set 'load.pinion_torque_Nm=[1e9]' >/dev/null 2>&1
[[ $? -eq 3 ]] && same_state old "$before" "a run that fails took the old results" || fail "a run that fails"
# So does one that is killed anywhere; it can be gone on with, also while results are being put in place.
many=(--set mesh_cycle.positions=24 --force)
run -o whole "${many[@]}" >/dev/null 2>&1 || fail "the run to compare with"
for k in $(seq 12); do
  rm -rf killed; cp -r old killed
  "$flank" run "$helical" "${small[@]}" -o killed "${many[@]}" >/dev/null 2>&1 & pid=$!
  sleep 0.$((RANDOM % 6))$((RANDOM % 10)); kill -9 $pid 2>/dev/null; wait $pid 2>/dev/null
  [[ -e killed/unfinished ]] || cmp -s killed/te.csv whole/te.csv ||
    same_state killed "$before" "killed before it began"
  run -o killed --resume "${many[@]}" >/dev/null 2>message || { cat message; fail "going on after a kill"; }
  cmp killed/te.csv whole/te.csv && [[ ! -e killed/unfinished ]] || fail "after a kill the tables are others"
done
# Killed between any two files while results are put in place: as if it was, file by file.
for moved in 0 1 3 5; do
  rm -rf killed; cp -r old killed; mkdir -p killed/unfinished/new
  (cd whole && find . -type f ! -name manifest.txt -printf '%P\n' | sort) >names
  while read -r name; do cp whole/"$name" killed/unfinished/new/"$name"; done <names
  echo "$marker" >killed/unfinished/flank.txt
  cp whole/manifest.txt killed/unfinished/manifest.txt
  sed -n "1,${moved}p" names | while read -r name; do mv killed/unfinished/new/"$name" killed/"$name"; done
  "$flank" run "$helical" "${small[@]}" "${many[@]}" -o killed --resume >screen 2>/dev/null &&
    grep -q "nothing to do" screen || fail "results half in place ($moved)"
  [[ $(state killed) == $(state whole) ]] || fail "results half in place are put there ($moved)"
done

# Two in one folder: the second is refused with the owner's host and process; a dead owner's lock goes.
long=(--set mesh_cycle.positions=512)
"$flank" run "$helical" "${small[@]}" -o locked "${long[@]}" >/dev/null 2>&1 & pid=$!
until [[ -e locked/unfinished/flank.txt ]]; do
  kill -0 $pid 2>/dev/null || fail "the long run ended"; sleep 0.02
done
refused "process $pid on $(hostname)" -o locked "${long[@]}"
refused "process $pid on $(hostname)" -o locked "${long[@]}" --resume
refused "process $pid on $(hostname)" -o locked "${long[@]}" --force
kill -9 $pid; wait $pid 2>/dev/null
run -o locked "${long[@]}" --resume >/dev/null 2>&1 || fail "a dead owner's lock"
# Owners on another host, by their signs of life.
mkdir -p far/unfinished
printf 'elsewhere\nboot\n4711\n99\n' >far/unfinished/lock-whole
refused "process 4711 on elsewhere" -o far
# A container has the host's name and boot, and other processes; a time ahead of the folder's own counts as no
# sign of life for ever.
boot=$(cat /proc/sys/kernel/random/boot_id)
printf '%s\n%s\n1\n99\npid:[1]\n' "$(hostname)" "$boot" >far/unfinished/lock-whole
refused "process 1 on $(hostname)" -o far
: >far/unfinished/lock-whole; refused "somebody whose lock cannot be read" -o far
touch -d '1 day' far/unfinished/lock-whole
run -o far >/dev/null 2>&1 || fail "an owner whose signs of life lie ahead"
rm -r far; mkdir -p far/unfinished; printf 'elsewhere\nboot\n4711\n99\n' >far/unfinished/lock-whole
touch -d '2 minutes ago' far/unfinished/lock-whole
run -o far >/dev/null 2>&1 || fail "an owner elsewhere that shows no life"
# Signals that end programs, of batch systems too: exit code 4, and what was finished is there.
for signal in TERM INT HUP USR2 XCPU; do
  setsid "$flank" run "$helical" "${small[@]}" "${long[@]}" -o stopped_$signal >/dev/null 2>message & pid=$!
  until ls stopped_$signal/unfinished/*.journal >/dev/null 2>&1; do
    kill -0 $pid 2>/dev/null || fail "the long run ended"; sleep 0.02
  done
  kill -$signal $pid; wait $pid; [[ $? -eq 4 ]] && grep -q -- "--resume" message || fail "SIG$signal"
done
nohup "$flank" run "$helical" "${small[@]}" "${long[@]}" -o kept_on >/dev/null 2>message & pid=$!
until ls kept_on/unfinished/*.journal >/dev/null 2>&1; do
  kill -0 $pid 2>/dev/null || fail "the long run ended"; sleep 0.02
done
kill -HUP $pid; wait $pid || { cat message; fail "nohup"; }
run "${long[@]}" -o stopped_TERM --resume >/dev/null 2>message && grep -q "going on" message &&
  cmp stopped_TERM/te.csv locked/te.csv || fail "going on after SIGTERM"

# A manifest that lists what lies behind a link; a report that was killed; names too long; folders made on the
# way to a run that fails; a run that starts while another one ends.
rm -rf linked pics; cp -r first linked; mkdir -p pics linked/figures; echo mine >pics/x.svg
ln -s ../../pics linked/figures/sub
crc=$(/usr/bin/python3 -c '
import zlib
data = open("pics/x.svg", "rb").read()
print("%08x %d" % (zlib.crc32(data), len(data)))')
files=$(sed -n 's/^files: //p' linked/manifest.txt)
sed -i "s/^files: .*/files: $((files + 1))/; /^case:/i $crc figures/sub/x.svg" linked/manifest.txt
refused "damaged or not Flank's" -o linked
[[ $(cat pics/x.svg) == mine ]] || fail "removed behind a link"
run -o reported >/dev/null 2>&1; mkdir reported/.report-0123456789abcdef
run -o reported >/dev/null 2>message || { cat message; fail "what a killed report left"; }
long_name=$(printf 'abcdefgh/%.0s' {1..460})
refused "at most" -o "$long_name"; [[ ! -e abcdefgh ]] || fail "folders of a name too long"
run -o deep/er/est --set 'load.pinion_torque_Nm=[1e9]' >/dev/null 2>&1; [[ $? -eq 3 && ! -e deep ]] ||
  fail "folders made on the way to nothing"
for try in 1 2 3 4 5 6; do
  rm -rf race
  for grid in 5 7 9; do
    (run -o race --set contact_grid.slices=$grid >/dev/null 2>race_$grid; echo $? >race_$grid.code) &
  done
  wait
  [[ $(cat race_?.code | sort | tr -d '\n') == 022 ]] ||
    { cat race_?.code race_?; fail "three runs at once"; }
  first_come=$(grep -l '^0$' race_?.code); first_come=${first_come%.code}; first_come=${first_come#race_}
  grep -q "contact_grid.slices = $first_come$" race/manifest.txt || fail "replaced without --force"
done

# Links, copies and pipes in the places of Flank's own: nothing behind them is read,
# written or removed; and nothing hangs.
same_after() { # FOLDER WHAT ARGUMENTS...: refused, and the folder is as it was
  local folder=$1 what=$2 before; shift 2; before=$(state "$folder")
  timeout 20 "$flank" run "$helical" "${small[@]}" "$@" >/dev/null 2>message
  [[ $? -eq 2 ]] || { cat message; fail "$what: not refused"; }
  ! grep -q SECRET message || fail "$what: a foreign file's content"
  same_state "$folder" "$before" "$what"
}
rm -rf own somebody
mkdir own somebody; echo mine >somebody/view.py; ln -s ../somebody own/fields
same_after somebody "fields that are a link" -o own --set 'output.fields=["contact"]' --force
rm own/fields; mkdir own/fields; echo mine >own/fields/view.py
same_after own "somebody's own view.py" -o own --set 'output.fields=["contact"]' --force
rm -rf own; mkdir -p own/unfinished; echo mine >somebody/te.csv
{ echo "$marker"; echo run; sed '1,/^case:$/d' whole/manifest.txt; } >own/unfinished/flank.txt
ln -s ../../somebody own/unfinished/new
same_after somebody "unfinished results that are a link" -o own
same_after somebody "unfinished results that are a link, forced" -o own --force
for name in lock-plan.odt flank.txt.notes lock-part-; do
  rm -rf own; mkdir -p own/unfinished
  echo mine >own/unfinished/$name; touch -d '3 hours ago' own/unfinished/$name
  same_after own "somebody's unfinished/$name" -o own
  same_after own "somebody's unfinished/$name, forced" -o own --force
done
rm -rf own; mkdir -p own/unfinished; echo "a plan of the lock" >own/unfinished/lock-whole
touch -d '3 hours ago' own/unfinished/lock-whole
same_after own "somebody's unfinished/lock-whole" -o own
rm -rf own; mkdir own; cp -r whole own/unfinished
same_after own "a copy of results called unfinished" -o own --force
rm -rf own; cp -r whole own; cp -r old own/unfinished
same_after own "a copy of results in results" -o own --resume --force
rm -rf own; mkdir -p own/unfinished; mkfifo own/unfinished/lock-whole
same_after own "a lock that is a pipe" -o own
rm -rf own; mkdir -p own/unfinished; printf 'SECRET1\nx\nSECRET3\ny\n' >secret
touch -d '1 hour ago' secret; ln -s ../../secret own/unfinished/lock-whole
same_after own "a lock that is a link" -o own
rm -rf own; mkdir own
run -o own --set 'load.pinion_torque_Nm=[1e9]' >/dev/null 2>&1
[[ $? -eq 3 && -d own ]] || fail "somebody's own empty folder goes with a run that fails"
# A file that somebody makes, or changes, while a run lasts: it and all old results stay;
# then the new ones can be put in their places.
rm -rf own; cp -r old own
"$flank" run "$helical" "${small[@]}" -o own "${long[@]}" --force >/dev/null 2>message & pid=$!
until ls own/unfinished/*.journal >/dev/null 2>&1; do
  kill -0 $pid 2>/dev/null || fail "the long run ended"; sleep 0.02
done
echo "# note" >>own/te.csv
before=$(cd own && cksum ./*.csv results.h5 case.toml manifest.txt)
wait $pid
[[ $? -eq 3 ]] && grep -q "is not Flank's" message ||
  { cat message; fail "a result that changes while a run lasts"; }
[[ $(cd own && cksum ./*.csv results.h5 case.toml manifest.txt) == "$before" ]] ||
  fail "old results are half replaced"
cp old/te.csv own/te.csv
"$flank" run "$helical" "${small[@]}" -o own "${long[@]}" --force --resume >/dev/null 2>message ||
  { cat message; fail "what waited is put in its place"; }
cmp own/te.csv locked/te.csv || fail "what waited is put in its place: other tables"
# A folder that is moved while a run works in it, and the place taken by another run: that one's results stay,
# the first says so, on any of its ranks, and where its folder lies now it is gone on with.
for ranks in 1 2; do
  rm -rf moved away
  command=("$flank"); [[ $ranks -eq 1 ]] || command=(mpirun --oversubscribe -n $ranks "$flank")
  "${command[@]}" run "$helical" "${small[@]}" -o moved "${long[@]}" >/dev/null 2>message & pid=$!
  until ls moved/unfinished/*.journal >/dev/null 2>&1; do
    kill -0 $pid 2>/dev/null || fail "the run that is moved ended"; sleep 0.02
  done
  mv moved away
  run -o moved >/dev/null 2>&1 || fail "a run where another one's folder stood"
  before=$(state moved)
  wait $pid
  [[ $? -eq 3 ]] && grep -q "moved was moved or removed, or somebody took it over, while this run" message ||
    { grep -v "^contact: " message; fail "a folder that is moved while a run on $ranks ranks lasts"; }
  same_state moved "$before" "a moved run's end among another one's results"
  "$flank" run "$helical" "${small[@]}" -o away "${long[@]}" --resume >/dev/null 2>message ||
    { grep -v "^contact: " message; fail "going on in the place to which a folder was moved"; }
  grep -q "going on: " message && cmp away/te.csv locked/te.csv ||
    { grep -v "^contact: " message; fail "the moved run's finished positions"; }
done
# A part of a study does not take another part's work, forced or not.
cat "$helical" - >parts.toml <<'END'
[[study]]
set = "pinion.lead_crown.amount_um"
from = 0
to = 9
count = 800
END
sed 's/to = 9/to = 8/' parts.toml >others.toml
"$flank" study parts.toml "${small[@]}" --part 1/2 -o parts >/dev/null 2>&1 & pid=$!
until ls parts/unfinished/*.journal >/dev/null 2>&1; do
  kill -0 $pid 2>/dev/null || fail "the part ended"; sleep 0.02
done
"$flank" study others.toml "${small[@]}" --part 2/2 -o parts --force >/dev/null 2>message
[[ $? -eq 2 ]] && grep -q "in use by process" message ||
  { cat message; fail "a part of another study, forced"; }
wait $pid || fail "the part that was there first"

# Files that may not grow, as on a full disk (a limit of the size of files, in blocks of 1024 bytes).
for blocks in 0 8 40 100 200; do
  (
    ulimit -f $blocks
    FLANK_CACHE= XDG_CACHE_HOME=/proc/none run -o full_$blocks --set mesh_cycle.positions=24
  ) 2>&1 >/dev/null | cat >message
  code=${PIPESTATUS[0]}
  [[ $code -eq 3 || $code -eq 0 ]] ||
    { cat message; fail "a full disk after $blocks blocks: exit code $code"; }
  if [[ $code -eq 3 ]]; then
    [[ $(grep -c "cannot write" message) -eq 1 &&
      ! -e full_$blocks/te.csv && ! -e full_$blocks/results.h5 ]] ||
      { cat message; fail "a full disk after $blocks blocks"; }
    run -o full_$blocks --resume --set mesh_cycle.positions=24 >/dev/null 2>message ||
      fail "going on after a full disk"
  fi
  cmp full_$blocks/te.csv whole/te.csv || fail "after a full disk the tables are others"
done
"$flank" schema >/dev/full 2>message
[[ $? -eq 3 && $(wc -l <message) -eq 1 ]] || fail "standard output that takes nothing"
"$flank" schema 2>message | true; [[ ${PIPESTATUS[0]} -ne 141 ]] || fail "a closed pipe"
echo "1 passed, 0 failed"
