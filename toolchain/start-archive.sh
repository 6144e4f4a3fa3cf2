# SPDX-License-Identifier: Apache-2.0
# Builds the initial RAM archive of a kernel; sourced by toolchain/guest and toolchain/appliance.

# addModules ROOT KERNEL-TREE MODULES..: copies them and what they need to ROOT/mods, uncompressed, and their order to
# ROOT/mods/order. A module built into the kernel has no file.
addModules() {
  local root=$1 tree module line needed file
  tree=$2/lib/modules/$(ls "$2/lib/modules")
  mkdir -p "$root/mods"
  for module in "${@:3}"; do
    line=$(grep -E "/${module//-/[-_]}\.ko(\.xz)?:" "$tree/modules.dep" || true)
    [[ -n $line ]] || continue
    for needed in $(tr ' ' '\n' <<<"${line#*:}" | tac) "${line%%:*}"; do
      file=$(basename "$needed" .xz)
      [[ -e $root/mods/$file ]] && continue
      xz -dcf "$tree/$needed" >"$root/mods/$file"
      echo "$file" >>"$root/mods/order"
    done
  done
}

# packArchive ROOT FILE
packArchive() {
  (cd "$1" && find . | cpio -o -H newc --quiet | gzip -1) >"$2"
}
