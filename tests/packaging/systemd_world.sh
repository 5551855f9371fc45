# A small world with a systemd of its own, on a copy of a system that nothing outside sees. Sourced by what unshare runs;
# sets `root`, where that copy lies.
# shellcheck shell=sh

# make_world FOLDER SYSTEM: FOLDER is empty; what is changed in SYSTEM stays in the memory of this world
make_world() {
    mount -t tmpfs tmpfs "$1"
    mkdir "$1/changed" "$1/work" "$1/root"
    root=$1/root
    mount -t overlay overlay -o "lowerdir=$2,upperdir=$1/changed,workdir=$1/work" "$root"
    mount -t proc proc "$root/proc"
    mount -t tmpfs tmpfs "$root/run"
    mount --rbind /dev "$root/dev"
    mount --rbind /sys "$root/sys"
    # systemd 258 works with version 2 of control groups only, whichever this system uses.
    mount -t cgroup2 cgroup2 "$root/sys/fs/cgroup"
    ip link set lo up
}

# shut_in: for a system that boots whole, with a clock daemon and all: the kernel's settings and devices are not its own
shut_in() {
    mount --bind "$root/proc/sys" "$root/proc/sys"
    mount -o remount,bind,ro "$root/proc/sys"
    mount -o remount,bind,ro "$root/sys"
    mount -t tmpfs -o mode=755 tmpfs "$root/dev"
    mkdir "$root/dev/shm" "$root/dev/pts"
    mount -t tmpfs shm "$root/dev/shm"
    mount -t devpts -o newinstance,ptmxmode=0666 devpts "$root/dev/pts"
    ln -s pts/ptmx "$root/dev/ptmx"
    ln -s /proc/self/fd "$root/dev/fd"
    for device in "null 1 3" "zero 1 5" "full 1 7" "random 1 8" "urandom 1 9" "tty 5 0"; do
        # shellcheck disable=SC2086 - its numbers
        mknod -m 666 "$root/dev/${device%% *}" c ${device#* }
    done
}

# run_systemd [OPTION ...]: as process 1; it may neither set the clock nor load modules nor turn the machine off
run_systemd() {
    exec setpriv --bounding-set=-sys_time,-sys_module,-sys_boot,-sys_rawio \
        chroot "$root" /usr/bin/env -i container=other PATH=/usr/sbin:/usr/bin:/sbin:/bin \
        /lib/systemd/systemd --system --show-status=no "$@"
}
