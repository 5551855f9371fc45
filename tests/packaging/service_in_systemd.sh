# Runs systemd as process 1 on a copy of this system that nothing outside sees, with the service installed.
# Arguments: an empty folder, the repository, a Python of the system, the folder of packages that it is to see. To be
# run by unshare.
set -e
folder=$1 repository=$2 python=$3 packages=$4

. "$(dirname "$0")/systemd_world.sh"
make_world "$folder" /

make -s -C "$repository" install-service install-maps-service DESTDIR="$root" PREFIX=/opt/robot-bridge PROGRAM=no
mkdir -p "$root/opt/robot-bridge/bin" "$root/opt/robot-bridge/packages" "$root/var/lib/robot-bridge"
# The service sees no /tmp of others, where the repository may lie.
# With its times, by which Python knows that what it compiled of them is still theirs.
cp -a "$repository/robot_bridge" "$root/opt/robot-bridge/"
mount --bind "$packages" "$root/opt/robot-bridge/packages"
printf '#!/bin/sh\nexport PYTHONPATH=/opt/robot-bridge:/opt/robot-bridge/packages\nexec %s "$@"\n' "$python" > "$root/opt/robot-bridge/bin/python"
chmod 755 "$root/opt/robot-bridge/bin/python"
# Nothing else of this system is to start; the log goes where a test can read it.
for unit in robot-bridge robot-bridge-link@ robot-bridge-maps robot-bridge-archive; do
    mkdir -p "$root/etc/systemd/system/$unit.service.d"
    cat > "$root/etc/systemd/system/$unit.service.d/alone.conf" <<'END'
[Unit]
DefaultDependencies=no
[Service]
StandardOutput=append:/var/log/robot-bridge.log
StandardError=append:/var/log/robot-bridge.log
END
done
# The packages lie elsewhere than where the program is installed.
printf '[Service]\nEnvironment=PYTHONPATH=/opt/robot-bridge:/opt/robot-bridge/packages\n' \
    > "$root/etc/systemd/system/robot-bridge-maps.service.d/packages.conf"
mkdir -p "$root/etc/robot-bridge/links"
printf 'kind = "tracker"\n[tracker]\nhttp = "127.0.0.1:5055"\n' > "$root/etc/robot-bridge/links/phones.toml"
chroot "$root" systemd-sysusers /usr/lib/sysusers.d/robot-bridge.conf
# As the installation does where there is no DESTDIR.
chroot "$root" chgrp -R robot-bridge /etc/robot-bridge
cp -r "$repository/resources/sample_site" "$root/var/lib/robot-bridge/site"
chroot "$root" chown -R robot-bridge: /var/lib/robot-bridge

run_systemd --unit=robot-bridge.service
