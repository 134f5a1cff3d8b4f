const holder = document.getElementById('kith-report');
const report = JSON.parse(holder?.textContent ?? '{}') as { title?: string };
const heading = document.createElement('h1');
heading.textContent = report.title ?? 'Report';
document.getElementById('page')?.append(heading);
