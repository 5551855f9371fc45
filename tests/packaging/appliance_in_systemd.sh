# Boots the small computer of the appliance's test. Arguments: an empty folder, the repository, the system's root folder.
# To be run by unshare.
set -e
folder=$1 repository=$2 system=$3
. "$(dirname "$0")/systemd_world.sh"
make_world "$folder" "$system"
shut_in

mkdir -p "$root/srv/fleet/resources" "$root/srv/wheels"
for part in pyproject.toml README.md LICENSE robot_bridge tools resources/service resources/sample_site; do
    cp -r "$repository/$part" "$root/srv/fleet/$part"
done
echo small >"$root/etc/hostname"
printf '127.0.0.1 localhost small\n' >"$root/etc/hosts"
hostname small
# What the kernel or the mount table of this machine is asked for is no part of it.
for unit in systemd-udevd getty@tty1 console-getty systemd-logind systemd-remount-fs; do
    ln -sf /dev/null "$root/etc/systemd/system/$unit.service"
done
rm -f "$root/usr/sbin/policy-rc.d"
run_systemd
