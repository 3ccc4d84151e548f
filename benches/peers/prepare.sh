# What the scripts of this folder begin with. Sets `here` to this folder, and `folder` to the first argument, which it takes from the
# arguments. Makes that folder, with the virtual environment in which the other engines are installed.
here=$(cd "$(dirname "$0")" && pwd)
folder=${1:-$here/../../target/peers}
shift || true
mkdir -p "$folder"
folder=$(cd "$folder" && pwd)

if ! cmp -s "$here/requirements.txt" "$folder/venv/installed.txt"; then
    "${PYTHON:-python3}" -m venv "$folder/venv"
    "$folder/venv/bin/pip" install --quiet --disable-pip-version-check -r "$here/requirements.txt"
    cp "$here/requirements.txt" "$folder/venv/installed.txt"
fi
