// Reads the part of TOML that studies/paper-targets.toml uses: arrays of tables with keys on one line.
export function readTables(text) {
  const tables = {};
  let table = {};
  for (const raw of text.split('\n')) {
    const line = raw.replace(/^\s+|\s+$/g, '');
    const header = /^\[\[(\w+)\]\]/.exec(line);
    const pair = /^([\w-]+)\s*=\s*("(?:[^"\\]|\\.)*"|\[[^\]]*\]|[^#]+)/.exec(line);
    if (header) {
      table = {};
      (tables[header[1]] ??= []).push(table);
    } else if (pair) {
      table[pair[1]] = JSON.parse(pair[2].trim());
    } else if (line && !line.startsWith('#')) {
      throw new Error(`cannot read this line of the targets: ${line}`);
    }
  }
  return tables;
}
