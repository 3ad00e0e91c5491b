#!/usr/bin/env bash
# Installs the packages of makefiles/packages.txt, and of the lists that are named besides, that are missing. Says
# nothing when there is nothing to do.
set -euo pipefail
cd "$(dirname "$0")"
wanted=$(sed -e 's/#.*//' packages.txt "$@" | xargs)
missing=()
for package in $wanted; do
  [ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null || true)" = installed ] || missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

if ! command -v apt-get >/dev/null; then
  echo "floe's set-up installs Debian 12 packages with apt-get, which this machine does not have." >&2
  echo "Install these by hand, then run make again: ${missing[*]}" >&2
  exit 1
fi
sudo=
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || { echo "Not root and no sudo: ask for these packages: ${missing[*]}" >&2; exit 1; }
  sudo=sudo
fi
echo "Installing ${#missing[@]} Debian packages: ${missing[*]}"
export DEBIAN_FRONTEND=noninteractive
log=$(mktemp)
trap 'rm -f "$log"' EXIT
if ! { $sudo apt-get update && $sudo apt-get install -y --no-install-recommends "${missing[@]}"; } >"$log" 2>&1; then
  tail -n 20 "$log" >&2
  exit 1
fi
