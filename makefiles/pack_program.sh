#!/usr/bin/env bash
# pack_program.sh PROGRAM... FOLDER: programs with the libraries and the Open MPI that they need, for one Linux machine
# that has none of them (not those of floe plot and report), with such a processor and glibc 2.36 or newer:
#   makefiles/pack_program.sh build/floe build/tests/offline_stage packed && tar cJf packed.tar.xz packed
#   packed/mpirun -n 16 packed/bin/floe run scene.yaml        # there; one rank, too, is started by mpirun
set -euo pipefail
folder=${!#}
[ ! -e "$folder" ] || { echo "pack_program.sh: $folder exists already" >&2; exit 2; }
mkdir -p "$folder"/{bin,lib,prefix}
openmpi=/usr/lib/x86_64-linux-gnu/openmpi/lib/openmpi3
pmix=/usr/lib/x86_64-linux-gnu/pmix2
for program in "${@:1:$#-1}"; do install -s "$program" "$folder/bin/"; done
cp -L /usr/bin/orterun "$folder/bin/mpirun"
# what the programs and Open MPI's plug-ins are linked with, but for the C library, which belongs to the machine
{ ldd "$folder"/bin/* "$openmpi"/*.so "$pmix"/lib/pmix/*.so 2>/dev/null || true; } |
  awk '$2 == "=>" && $3 ~ "^/" { print $3 }' | sort -u |
  grep -vE '/(libc|libm|libpthread|libdl|librt|libresolv|libutil|ld-linux[^/]*)\.so' | xargs -I{} cp -L {} "$folder/lib/"
cp -r "$openmpi" "$folder/prefix/openmpi"
mkdir -p "$folder"/prefix/{share,pmix/lib,pmix/share} && cp -rL /usr/share/openmpi "$folder/prefix/share/openmpi"
cp -r "$pmix/lib/pmix" "$folder/prefix/pmix/lib/pmix" && cp -r "$pmix/share/pmix" "$folder/prefix/pmix/share/pmix"
cat > "$folder/mpirun" <<'RUN'
#!/usr/bin/env bash
here=$(cd "$(dirname "$0")" && pwd)
export LD_LIBRARY_PATH=$here/lib OPAL_PREFIX=$here/prefix OMPI_MCA_mca_base_component_path=$here/prefix/openmpi
export PMIX_PREFIX=$here/prefix/pmix PMIX_MCA_mca_base_component_path=$here/prefix/pmix/lib/pmix PMIX_MCA_pcompress_base_silence_warning=1 OMPI_MCA_plm=${OMPI_MCA_plm:-isolated}  # one machine
exec "$here/bin/mpirun" "$@"
RUN
chmod +x "$folder/mpirun"
