// Columns of numbers as eomgen/page/packing.py packs them.

const HOLES = { nan: NaN, inf: Infinity, "-inf": -Infinity };

/** The bytes of base64. */
export const bytesOf = text => Uint8Array.from(atob(text), c => c.charCodeAt(0));

/** The columns, a Float64Array each. */
export function unpackedColumns({ rows, columns }, content) {
    let at = 0;
    const next = () => {
        let v = 0, size = 1, byte;
        do { byte = content[at++]; v += (byte & 127)*size; size *= 128; } while (byte > 127);
        return v % 2 ? -(v + 1)/2 : v/2;
    };
    return columns.map(([power, order, holes]) => {
        const whole = Float64Array.from({ length: rows }, next);
        for (let k = 0; k < order; k++) for (let i = 1; i < rows; i++) whole[i] += whole[i - 1];
        const found = whole.map(v => power < 0 ? v/10**-power : v*10**power);
        for (const [first, count, word] of holes) found.fill(HOLES[word], first, first + count);
        return found;
    });
}

/** The same row by row. */
export function unpackedRows(told) {
    const columns = unpackedColumns(told, bytesOf(told.content)), n = columns.length, found = new Float64Array(told.rows*n);
    columns.forEach((column, j) => column.forEach((v, i) => { found[i*n + j] = v; }));
    return found;
}
