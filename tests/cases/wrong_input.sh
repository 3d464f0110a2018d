#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-or-later
# Input that is wrong, hostile or too large: one line, exit code 2, nothing written,
# nothing of other files shown; keys that would do nothing.
source "$(dirname "$0")/shell.sh"
helical=$root/cases/parallel_axis/helical.toml
wrong() { # WORDS COMMAND...
  local words=$1; shift
  timeout 20 "$flank" "$@" >screen 2>message; local code=$?
  [[ $code -eq 2 ]] || { head -c 600 message; fail "exit code $code: ${*:0:200}"; }
  [[ $(wc -l <message) -eq 1 && $(wc -c <message) -lt 2000 && ! -s screen ]] ||
    { head -c 600 message; fail "not one line: $words"; }
  grep -q -- "$words" message || { head -c 600 message; fail "not said: $words"; }
  ! grep -qP '[\x00-\x09\x0b-\x1f\x7f]' message || fail "control characters in a message"
  [[ ! -e out ]] || fail "wrong input wrote something"
}
set_wrong() { # WORDS SETTING...
  local words=$1 settings=(); shift
  for setting in "$@"; do settings+=(--set "$setting"); done
  wrong "$words" check "$helical" "${settings[@]}"
}
letters() { head -c "$1" /dev/zero | tr '\0' a; }

# Indices that are none, keys that would do nothing.
for index in 0 00 01 -1 99999 2147483648 4294967297 1.5 '' a; do
  set_wrong "pinion.bias" "pinion.bias[$index].amount_um=3"
done
set_wrong "there is no pinion.bias\[1\]" 'pinion.bias[3].amount_um=3'
set_wrong "no effect" output.field_teeth=3
set_wrong "no effect" 'output.field_positions=[0]'
set_wrong "no effect" pinion.end_relief.length_mm=3
set_wrong "no effect" pinion.runout.angle_deg=3
set_wrong "no effect" contact.classical_depth=line_fit
for output in root_stress subsurface_stress light_load_pattern; do
  set_wrong "output.$output = .*every torque of load.pinion_torque_Nm is 0" output.$output=yes \
    'load.pinion_torque_Nm=[0]'
done
set_wrong "pinion.root_diameter_mm = 1: .*no room for a bore" pinion.root_diameter_mm=1
for approximation in geometry=linear candidates=window drop_interfering=yes; do
  wrong "no effect on the exactly conjugate profile" check "$root/cases/double_roller/conjugate.toml" \
    --set model.$approximation
done
set_wrong "amount_um: missing" pinion.root_relief.shape=linear
"$flank" check "$helical" --set contact.split=classical --set contact.classical_depth=line_fit >/dev/null ||
  fail "a key that has an effect"
"$flank" check "$helical" --set 'output.fields=["contact"]' --set 'output.field_positions=[1]' \
    --set output.error_estimate=yes >/dev/null ||
  fail "an error estimate beside fields"
wrong "no effect on contact fields" check "$helical" --set 'output.fields=["contact"]' \
  --set output.field_teeth=3
for repeated in 'output.fields=["contact","stress","contact"]' 'output.field_positions=[1,0,1]' \
  'output.field_torques_Nm=[50,50]'; do
  wrong "says the same twice" check "$helical" --set 'output.fields=["contact"]' --set "$repeated"
done
wrong "is given twice" check "$root/cases/double_roller/exact.toml" \
  --set 'output.pressure_maps_deg=[0, 1, 1.0]'
wrong "not expected" run "$helical" --bogus
# Tilts, single teeth and runout that would bring the coast flanks into contact. By hand for the spur pair,
# with 0.1448 mm of backlash at the pitch circles, 136 um along the normal: a tilt of 1 mm in the plane of
# action takes 1000 cos(20 deg)^2 = 883 um (found in the middles of 61 slices, at the best phase of a relieved
# pair), across it 1000 sin(40 deg) / 2 = 321 um; a runout of 1 mm takes 2 sin(20 deg) of its half.
spur=$root/cases/parallel_axis/spur_tip_relief_23p6.toml
errors=$(printf ',0%.0s' {2..50})
jams() {
  local expected=$1
  shift
  local settings=()
  for setting in "$@"; do settings+=(--set "$setting"); done
  wrong "$expected" check "$spur" "${settings[@]}"
}
jams "misalignment takes 8[5-8].* um.* at most 136 um along the normal" misalignment.in_plane_um=1000
jams "misalignment takes 8[5-8].* um" misalignment.in_plane_um=-1000
jams "misalignment takes 3[01].* um" misalignment.across_plane_um=1000
jams "single teeth 1000 um" "pinion.index_errors_um=[-500$errors]"
jams "runout 684 um" pinion.runout.amount_um=1000
fine() {
  local settings=()
  for setting in "$@"; do settings+=(--set "$setting"); done
  "$flank" check "$spur" "${settings[@]}" >/dev/null || fail "within the backlash: $*"
}
fine misalignment.in_plane_um=150
fine misalignment.across_plane_um=400
fine "pinion.index_errors_um=[60$errors]"
# A crown takes up what a tilt does; teeth that are never in mesh together do not add up.
fine misalignment.in_plane_um=300 pinion.lead_crown.amount_um=300
gear_even="gear.index_errors_um=[0$errors]"
jams "single teeth 1[78]. um" "$gear_even" mesh_cycle.period=\"hunting\" \
  "pinion.index_errors_um=[0,0,0,0,0,0,90,180,180,180,180,180,90$(printf ',0%.0s' {14..50})]"
far=$(printf ',0%.0s' {6..50})
fine "pinion.index_errors_um=[0,0,0,0,500$far]"
# Large, and right: no longer than it takes to look at it.
{
  printf '%s\n' 'scene = "double_roller"' '[drive]' 'rollers = 1000' 'roller_circle_radius_mm = 1500' \
    'roller_radius_mm = 2.5' 'sleeve_circle_radius_mm = 1495.5' 'sleeve_radius_mm = 3' 'eccentricity_mm = 1' \
    'width_mm = 10' 'youngs_modulus_GPa = 206' 'poissons_ratio = 0.3'
  printf 'roller_radius_errors_um = [%s1]\n' "$(printf '0.1, %.0s' $(seq 999))"
  printf '[load]\noutput_torque_Nm = [20]\n'
} >many.toml
timeout "${FLANK_PATIENCE:-20}" "$flank" check many.toml >screen 2>message
[[ $? -eq 0 || $? -eq 2 ]] || { head -c 300 message; fail "a drive of 1000 rollers with errors"; }
for threads in 0 -1 257 abc 2x 99999999999999999999 ''; do
  FLANK_THREADS=$threads wrong "allowed is an integer from 1 to 256" run "$helical" -o out
done
wrong "" run "$helical" -o
wrong "no effect" check "$root/cases/double_roller/exact.toml" \
  --set 'drive.crown={type="full",radius_mm=1000,straight_length_mm=3}'
set_wrong "an arc of this radius is longer than the relief; allowed is 0 to " \
  'pinion.tip_relief.blend_radius_mm=300000'
set_wrong "tip_relief.blend_radius_mm = 1000, which gear.like copies to gear.tip_relief.blend_radius_mm" \
  'pinion.tip_relief.blend_radius_mm=1000' 'gear.tip_relief.start_roll_angle_deg=26.5'
set_wrong "has no effect: a quadratic relief starts without a kink" \
  'pinion.tip_relief={ amount_um = 5, start_roll_angle_deg = 23.6, shape = "quadratic", blend_radius_mm = 9 }'
set_wrong "is empty" 'pinion.bias[7]={}'
set_wrong "is empty" 'gear.tip_relief={}'
set_wrong "derivatives are of studies, and there is no" output.derivatives=yes
set_wrong "variants are of studies" output.error_estimate=every_variant
"$flank" check "$helical" --set 'title=a" # b\' >screen || fail "a title with a quotation mark"
wrong "is empty" run "$helical" -o ''
wrong "is empty" study "$helical" --part ''
wrong "is empty" run "$helical" --accuracy ''
wrong "N at most 999999999" study "$helical" --part 1/1000000000
wrong "both give the accuracy" run "$helical" --accuracy draft --set 'accuracy="standard"'
wrong "both give the accuracy" run "$helical" --accuracy draft --set accuracy.mean_te_percent=1
wrong "must be one line, of one key" check "$helical" --set $'pinion.teeth=40\ngear.teeth=41'
wrong "none of the crank angles" run "$root/cases/double_roller/exact.toml" \
  --set 'output.pressure_maps_deg=[0.5]'
{ echo '"pinion.youngs_modulus_GPa" = 100'; cat "$helical"; } >quoted.toml
wrong "a name in quotes is no path" check quoted.toml
sed '/^\[pinion\]/a "bias[1].amount_um" = 9' "$helical" >quoted.toml
wrong "a name in quotes is no path" check quoted.toml
{ echo 'study = 5'; cat "$helical"; } >quoted.toml
wrong "must be a list of tables" check quoted.toml
wrong "must be a list of tables" run quoted.toml -o out
# What is too small for its geometry or to be told from nothing.
for torque in 1e-20 5e-324; do
  set_wrong "too little to be told from nothing" "load.pinion_torque_Nm=[$torque]"
done
set_wrong "is given twice" 'load.pinion_torque_Nm=[50, 50.0000000001]'
set_wrong "a bore is at least" pinion.bore_diameter_mm=1e-3
set_wrong "a fillet's radius is at least" gear.fillet_radius_mm=1e-3
set_wrong "a face width is at least a hundredth of the transverse module" pinion.face_width_mm=0.01
for setting in pinion.face_width_mm=1e-9 gear.fillet_radius_mm=1e-9 pair.centre_distance_mm=1e-300 \
  gear.youngs_modulus_GPa=1e-300 mounting.pinion_tilt_in_plane_Nm_per_mrad=1e-9; do
  set_wrong "out of bounds" $setting
done
for setting in drive.youngs_modulus_GPa=1e-300 drive.width_mm=1e-9 mesh_cycle.crank_angles_deg.step=1e-300; do
  wrong "out of bounds" check "$root/cases/double_roller/exact.toml" --set $setting
done
wrong "less than the sleeves' radius (900 um)" check "$root/cases/double_roller/exact.toml" \
  --set drive.sleeve_radius_mm=0.9 --set drive.uniform_clearance_um=1000
wrong "hundred-thousandth" check "$root/cases/double_roller/exact.toml" --set contact_grid.half_width_mm=1e-7
wrong "out of bounds" check "$root/cases/roller_pair/crowned.toml" --set first_roller.radius_mm=1e-6
wrong "too little" check "$root/cases/roller_pair/crowned.toml" --set 'load.normal_force_N=[1e-100]'
axis() { cat "$helical" - >axis.toml; wrong "$1" plan axis.toml; }
axis "unknown key" <<<$'[[study]]\nset = "pinion.bias[0].amount_um"\nvalues = [1, 2]'
axis "together_with_previous" <<'END'
[[study]]
set = "pinion.lead_crown.amount_um"
values = [1]
[[study]]
set = "gear.lead_crown.amount_um"
values = [1]
together_with_previous = "yes"
END
axis "spacing" <<<$'[[study]]\nset = "pinion.lead_crown.amount_um"\nfrom = 1\nto = 2\ncount = 3\nspacing = 7'
axis "two ways" <<<$'[[study]]\nset = "pinion.lead_crown.amount_um"\nvalues = [1, 2]\ncount = 3'
axis "cannot vary in a study" <<<$'[[study]]\nset = "output.root_stress"\nvalues = ["no", "yes"]'
axis "cannot vary in a study" <<'END'
[[study]]
set = "output"
values = [{root_stress = "yes"}, {root_stress = "no"}]
END
axis "is set by an axis before" <<'END'
[[study]]
set = "pinion.tip_relief.amount_um"
values = [1, 2]
[[study]]
set = "pinion.tip_relief"
values = [{amount_um = 5, start_roll_angle_deg = 28}]
END
axis "is empty" <<<$'[[study]]\nset = "pinion.lead_crown"\nvalues = [{amount_um = 1}, {}]'
{ cat "$helical"; printf '[[study]]\nset = "pinion.foo"\nvalues = [1]\n'; } >unknown.toml
wrong "unknown key" check unknown.toml
wrong "unknown key" run unknown.toml -o out
{ cat "$helical"; printf '[[study]]\nset = "pinion.lead_crown.amount_um"\nvalues = [1, 2]\n'; } >both.toml
wrong "is set by --set too" study both.toml --set pinion.lead_crown.amount_um=7 -o out
# A study's memory is that of the variant that needs most.
cat "$helical" - >large.toml <<'END'
[[study]]
set = ["contact_grid.slices", "contact_grid.profile_cells"]
rows = [[5, 5], [1001, 101]]
END
wrong "needs most would need about .* GB" study large.toml --accuracy draft -o out
axis "count = 1" <<<$'[[study]]\nset = "pinion.lead_crown.amount_um"\nfrom = 1\nto = 2\ncount = 1'
axis "file" <<<$'[[study]]\nfile = 7'
# Points that would make equal variants: equal as numbers; titles make no difference.
axis "points 1 and 2 are equal" <<'END'
[[study]]
set = "pinion.lead_crown.amount_um"
from = 1
to = 1
count = 3
END
for points in '[2, 1, 1.0]' '[0, 1, -0.0]'; do
  axis "are equal" <<<"[[study]]"$'\nset = "pinion.lead_crown.amount_um"\nvalues = '"$points"
done
axis "points 1 and 2 are equal" <<<$'[[study]]\nset = "load.pinion_torque_Nm"\nvalues = [100, [100.0]]'
axis "points 1 and 2 are equal" <<'END'
[[study]]
set = "pinion.topography.file"
values = ["measured_flank.csv", "./measured_flank.csv"]
END
axis "points 1 and 3 are equal" <<'END'
[[study]]
set = ["title", "pinion.lead_crown.amount_um"]
rows = [["a", 1], ["b", 2], ["c", 1]]
END
designs() { printf "$2" >designs.csv; axis "$1" <<<$'[[study]]\nfile = "designs.csv"'; }
designs "points 2 and 3 are equal" 'pinion.lead_crown.amount_um\n0\n1\n1e0\n'
designs "designs.csv:1: column 2 does not name a key" 'pinion.lead_crown.amount_um,\n1,\n'
designs "designs.csv:2: 2 values for 1 key" 'pinion.lead_crown.amount_um\n1,\n'
designs "designs.csv:3: cell 2 is empty: needed is a value of gear.lead_crown.amount_um" \
  'pinion.lead_crown.amount_um,gear.lead_crown.amount_um\n1,2\n3,\n'

# Names and texts of any length, tables in any number.
set_wrong "unknown key" "$(letters 100000)=1"
set_wrong "letters" "title=$(letters 100000)"
set_wrong "pinion.bias" "pinion.bias[$(letters 100000)].amount_um=1"
set_wrong "key=value" "$(letters 100000)"
set_wrong "levels\|letters\|unknown key" "$(printf 'a.%.0s' $(seq 20000))b=1"
wrong "" run "$helical" -o "$(letters 300)"
wrong "" run "$helical" -o "$(letters 5000)"
wrong "" run "$(letters 5000).toml"
{
  cat "$helical"; echo '[pinion.left_flank]'; echo 'bias = ['
  for _ in $(seq 20000); do
    echo '{ corner = 1, amount_um = 5, start_roll_angle_deg = 15, length_mm = 20 },'
  done
  echo ']'
} >many.toml
wrong "20000 tables" check many.toml
{ cat "$helical"; printf '%s' "$(printf 'a.%.0s' $(seq 20000))"; echo 'b = 1'; } >deep.toml
wrong "levels" check deep.toml
{ printf 'x = '; head -c 100000 /dev/zero | tr '\0' '['; } >deep.toml; wrong "not valid TOML" check deep.toml
{ cat "$helical"; echo "#"; head -c 17000000 /dev/zero | tr '\0' ' '; } >large.toml
wrong "17.* bytes" check large.toml
{ letters 200000; printf '\n1\n'; } >header.csv
axis "column 1 does not name a key" <<<$'[[study]]\nfile = "header.csv"'
printf 'scene = "parallel_axis"\n\0\0' >zeros.toml; wrong "not valid TOML" check zeros.toml

# Files that are none of ours: nothing of them is shown; what is no regular file is not opened.
echo 'password = "hunter2"' >secret.toml
wrong "scene: missing" check secret.toml
! grep -q hunter2 message || fail "a foreign file's content"
printf 'root:secret:0:0\nhunter2\n' >shadow
wrong "not valid TOML" check shadow
! grep -q 'hunter2\|secret:0' message || fail "a foreign file's content"
axis "does not name a key" <<<$'[[study]]\nfile = "shadow"'
! grep -q 'hunter2\|secret:0' message || fail "a foreign file's content as an axis"
topography() {
  set_wrong "$2" "pinion.topography.file=$1"
  ! grep -q 'hunter2\|secret:0' message || fail "a foreign file's content as a topography"
}
topography "$work/shadow" "first cell"
mkfifo pipe
wrong "not a regular file" check pipe
topography "$work/pipe" "not a regular file"
topography /dev/zero "not a regular file"
topography "$work" "is a folder"
axis "not a regular file" <<<$'[[study]]\nfile = "pipe"'
axis "not a regular file" <<<$'[[study]]\nfile = "/dev/random"'
ln -s loop loop; wrong "cannot be read" check loop
set_wrong 'helix' $'pair.helix_angle_deg=\e[31m"x\a"'

# Cells of tables that a spreadsheet would take for a formula; texts that a terminal would take for commands.
cat "$helical" - >formula.toml <<'END'
[[study]]
set = ["title", "gear.lead_crown.amount_um"]
rows = [["=cmd|x", 0], ["@sum", 1], ["-1+1", 2], ["plain", 3], ["＝1+1", 4], ["\u2028 =1", 5]]
END
"$flank" study formula.toml --accuracy draft --set mesh_cycle.positions=2 --set contact_grid.slices=5 \
    --set 'load.pinion_torque_Nm=[100]' -o formula >/dev/null 2>message ||
  { cat message; fail "study of titles"; }
[[ $(grep -c "^[0-9]*,'" formula/designs.csv) -eq 5 ]] || fail "a formula behind what is not seen"
! grep -q '^[0-9]*,[=@+-]' formula/designs.csv && grep -q "^0,'=cmd" formula/designs.csv ||
  fail "a formula in a table"
for letter in 0000 0007 0009 000a 001b 007f 009b; do
  set_wrong "title = .*control characters" "title=\"a\\u${letter}b\""
  set_wrong "topography.file = .*control characters" "pinion.topography.file=\"a\\u${letter}b\""
done

# Too large for the machine: refused before anything is allocated.
refused_memory() { # KILOBYTES ARGUMENTS...
  local most=$1; shift
  (ulimit -v "$most"; timeout 60 "$flank" "$@" >screen 2>message); local code=$?
  [[ $code -eq 2 ]] && grep -q "GB" message || { head -c 600 message; fail "memory: exit code $code: $*"; }
}
fine=(--set contact_grid.slices=1001 --set contact_grid.profile_cells=101)
if takes_limits; then
  refused_memory 6000000 run "$helical" "${fine[@]}" -o large
  refused_memory 1000000 run "$helical" -o small
  for most in 36000 38000 40000 42000 44000 48000 56000; do # not even MPI starts
    (ulimit -v $most; timeout 60 "$flank" run "$helical" -o small >screen 2>message); code=$?
    # 127: the loader itself has no room for the libraries.
    [[ $code -eq 2 || $code -eq 127 || ($code -eq 3 && $(wc -l <message) -eq 1) ]] &&
      ! grep -q OPAL message ||
      { head -c 600 message; fail "memory of $most kB: exit code $code"; }
  done
fi
refused_memory unlimited run "$helical" "${fine[@]}" -o large
# What one process finds room for, and two do not: 0.7 of what there is, by the plan, whose memory grows with
# the square of the slices. Nothing is allocated before it is refused.
free=$(sed -nE 's/.*GB, ([0-9.]+) GB are.*/\1/p' message)
slices=301 cells=(--set contact_grid.profile_cells=41)
for again in 1 2 3 4; do
  needed=$("$flank" plan "$helical" --ranks 2 "${cells[@]}" --set contact_grid.slices=$slices |
    sed -nE 's/.*; ([0-9.]+) GB a process.*/\1/p')
  slices=$(awk "BEGIN { print 2 * int($slices * sqrt(0.7 * $free / $needed) / 2) + 1 }")
done
timeout 30 mpirun --oversubscribe -n 2 "$flank" run "$helical" "${cells[@]}" \
  --set contact_grid.slices=$slices -o shared >screen 2>message
[[ $? -eq 2 ]] && grep -q "in each of 2 processes" message ||
  { head -c 600 message; fail "memory of two processes: $slices slices"; }
for key in pinion.lead_crown gear.lead_crown pinion.tip_relief pinion.profile_crown; do
  printf '[[study]]\nset = "%s"\nfrom = 1\nto = 4\ncount = 100\n' $key.amount_um
done | cat "$helical" - >huge.toml
start=$EPOCHREALTIME
"$flank" plan huge.toml >screen 2>message || { cat message; fail "plan of 1e8 variants"; }
grep -q "100000000 variants" screen && grep -q "GB" screen || fail "plan of 1e8 variants says its size"
# 1 s; 10 on a busy machine.
awk -v a="$start" -v b="$EPOCHREALTIME" -v most="${FLANK_PATIENCE:-10}" 'BEGIN { exit !(b - a < most) }' ||
  fail "plan of 1e8 variants takes long"
"$flank" study huge.toml -o huge >/dev/null 2>message
[[ $? -eq 2 ]] && grep -q "GB" message || fail "a study of 1e8 variants"

# Long axes are looked at in about a second, 10 on a busy machine.
long_axis() { # WORDS
  cat "$helical" - >long.toml
  local start=$EPOCHREALTIME
  "$flank" plan long.toml >screen 2>message || { head -c 300 message; fail "plan of a long axis: $1"; }
  grep -q "$1" screen || { cat screen; fail "plan of a long axis: $1"; }
  awk -v a="$start" -v b="$EPOCHREALTIME" -v most="${FLANK_PATIENCE:-10}" 'BEGIN { exit !(b - a < most) }' ||
    fail "plan of a long axis takes long: $1"
}
long_axis "1000 variants" < <(
  /usr/bin/python3 - <<'END'
corner = "{{ corner = 1, amount_um = {:.3f}, start_roll_angle_deg = 15, length_mm = 20 }}"
lists = [", ".join(corner.format(n % 32 + 1 + k / 1000) for n in range(64)) for k in range(1000)]
print('[[study]]\nset = "pinion.bias"\nvalues = [', ",\n".join(f"[{each}]" for each in lists), "]")
END
)
{
  echo 'pinion.lead_crown.amount_um,gear.lead_crown.amount_um'
  awk 'BEGIN { for (k = 0; k < 900000; ++k) print k % 900 ",", k / 1000 }'
} >long.csv
long_axis "900000 variants" <<<$'[[study]]\nfile = "long.csv"'
awk 'BEGIN { for (k = 0; k < 4100000; ++k) print k % 9000 }' | sed '1i pinion.lead_crown.amount_um' >long.csv
axis "at most 4000000 are read" <<<$'[[study]]\nfile = "long.csv"'

# Operators whose checksum is right and whose content is not: computed again with a word.
small=(--accuracy draft --set mesh_cycle.positions=2 --set contact_grid.slices=5
  --set 'load.pinion_torque_Nm=[100]' --set output.error_estimate=no)
rm -rf cache
"$flank" run "$helical" "${small[@]}" -o out/first >/dev/null 2>&1 || fail "run"
cp -r cache cache.kept
for kind in zeros ones counts negative cut nan shape 0.1 0.3 0.6 0.98; do
  rm -r cache; cp -r cache.kept cache
  /usr/bin/python3 - "$kind" cache/*.operator <<'END' || fail "an operator of $kind"
import struct, sys, zlib
kind, path = sys.argv[1:]
data = open(path, "rb").read()
key_bytes, payload_bytes = struct.unpack_from("<QQ", data, 8)
key, payload = data[32:32 + key_bytes], bytearray(data[32 + key_bytes:])
if kind == "zeros":
    payload[:] = bytes(len(payload))
elif kind == "ones":
    payload[:] = b"\xff" * len(payload)
elif kind == "counts":  # of the nodes' places
    struct.pack_into("<q", payload, 40, 1 << 61)
elif kind == "negative":
    struct.pack_into("<q", payload, 40, -5)
elif kind == "cut":
    payload = payload[:len(payload) // 2]
elif kind == "nan":
    struct.pack_into("<d", payload, len(payload) // 3 // 8 * 8, float("nan"))
elif kind == "shape":  # rows of the first matrix: 2^61
    count = struct.unpack_from("<q", payload, 40)[0]
    struct.pack_into("<q", payload, 48 + 8 * count + 4, 1 << 61)
else:  # a lost piece of a disk
    at = int(len(payload) * float(kind))
    payload[at:at + 2000] = bytes(2000)
checksum = zlib.crc32(payload, zlib.crc32(key))
head = data[:8] + struct.pack("<QQI", key_bytes, len(payload), checksum) + data[28:32]
open(path, "wb").write(head + key + payload)
END
  "$flank" run "$helical" "${small[@]}" -o out/again_$kind >/dev/null 2>message ||
    { cat message; fail "an operator of $kind"; }
  grep -q "cannot be used" message && cmp out/first/te.csv out/again_$kind/te.csv ||
    { cat message; fail "an operator of $kind is computed again"; }
done
# What dead processes were writing goes; what lives stays.
for writer in "$(hostname)-999999999" "$(hostname)-$$" "$(hostname)-999999998" elsewhere-1; do
  touch "cache/0123456789abcdef.operator.tmp-$writer-0"
done
touch -d '2 days ago' "cache/0123456789abcdef.operator.tmp-elsewhere-2-0"
# Just written, it may be a container's.
touch -d '2 minutes ago' "cache/0123456789abcdef.operator.tmp-$(hostname)-999999999-0"
head -c 1000 /dev/zero >/dev/shm/flank-999999999-0
"$flank" run "$helical" "${small[@]}" -o out/first >/dev/null 2>&1 || fail "run"
[[ $(ls cache/*.tmp-* | wc -l) -eq 3 && ! -e /dev/shm/flank-999999999-0 ]] || fail "what dead processes left"
# Standard output that is closed is said, as a full one is.
for command in "check $helical" "plan $helical" "report out/first"; do
  "$flank" $command >&- 2>message
  [[ $? -eq 3 ]] && grep -q "cannot write to standard output" message ||
    fail "closed standard output: $command"
done
PYTHONHOME=/nowhere "$flank" report out/first >/dev/null 2>message ||
  { cat message; fail "report in a foreign environment of Python"; }
# Limits of the process: raised where that is allowed, else one line.
too_little() { # LIMIT VALUE
  (ulimit -S "$1" "$2"; "$flank" run "$helical" "${small[@]}" -o out/soft >/dev/null 2>message) ||
    { cat message; fail "soft limit $1 $2"; }
  (ulimit "$1" "$2"; "$flank" run "$helical" "${small[@]}" -o out/hard >/dev/null 2>message)
  [[ $? -eq 3 && $(wc -l <message) -eq 1 ]] && grep -q "raise the limit" message ||
    { cat message; fail "limit $1 $2"; }
}
if takes_limits; then
  too_little -n 10; too_little -n 5; too_little -s 64; too_little -s 512
fi
# No folder can be there.
for place in /proc/x /proc/self/x "$helical/x" /dev/null/x; do
  "$flank" run "$helical" "${small[@]}" -o "$place" >/dev/null 2>message
  [[ $? -eq 2 && $(grep -vc '^plan:' message) -eq 1 ]] || { cat message; fail "-o $place"; }
done
# Axes that would make equal variants.
for axis in 'set = "title"\nvalues = ["a", "b"]' 'set = "gear.like"\nvalues = ["pinion", "pinion"]'; do
  printf "[[study]]\n$axis\n" | cat "$helical" - >equal.toml
  "$flank" study equal.toml -o equal >/dev/null 2>message
  [[ $? -eq 2 ]] && grep -q "changes nothing that is computed" message ||
    { cat message; fail "an axis that changes nothing"; }
done
"$flank" report nowhere 2>message; [[ $? -eq 2 && $(wc -l <message) -eq 1 ]] || fail "report of nothing"
echo "1 passed, 0 failed"
