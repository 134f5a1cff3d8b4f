// The sections that hold figures, in the order of the page; figures are numbered through.
import { completionFigures, correctFigures, knowledgeFigures } from '../figures/progress';
import { areaFigures } from '../figures/area';
import { differencesFigures } from '../figures/differences';
import type { Figure } from '../figures/figure';
import { estimateFigures } from '../figures/estimates';
import { examCurveFigures } from '../figures/exam';
import { forecastFigures } from '../figures/forecasts';
import { frontFigures } from '../figures/front';
import { matrixFigures } from '../figures/matrix';
import { outcomeFigures } from '../figures/outcomes';
import { timeFigures } from '../figures/time';
import { figureView } from '../figure_view';
import type { Study } from '../study';
import type { Section } from './section';
import { spheresSection } from './spheres';

const kSections: { id: string; title: string; figures(study: Study): Figure[] }[] = [
  { id: 'matrices', title: 'Settings against each other', figures: matrixFigures },
  {
    id: 'outcomes',
    title: 'Periods and knowledge',
    figures: (study) => [...differencesFigures(study).slice(1), ...outcomeFigures(study, false)],
  },
  {
    id: 'exam',
    title: 'The exam outside the lessons',
    figures: (study) => [...outcomeFigures(study, true), ...examCurveFigures(study), ...frontFigures(study)],
  },
  { id: 'manipulation', title: 'Manipulation check', figures: areaFigures },
  {
    id: 'progress',
    title: 'Progress over periods',
    figures: (study) => [...completionFigures(study), ...knowledgeFigures(study), ...correctFigures(study)],
  },
  { id: 'forecasts', title: 'Forecasts', figures: forecastFigures },
  { id: 'estimates', title: 'What the teacher can tell', figures: estimateFigures },
  { id: 'time', title: 'Where time goes', figures: timeFigures },
];

// The exam first where it leads.
function inOrder(study: Study): typeof kSections {
  if (study.report.overview.leads !== 'exam') return kSections;
  const leads = (id: string): boolean => id === 'exam';
  return [...kSections.filter(({ id }) => leads(id)), ...kSections.filter(({ id }) => !leads(id))];
}

// Figures are numbered in the order of the page.
export class FigureNumbers {
  private last = 0;
  next(): number {
    return ++this.last;
  }
}

export function figureSections(study: Study, numbers: FigureNumbers): Section[] {
  const sections: Section[] = [];
  for (const { id, title, figures } of inOrder(study)) {
    const views = figures(study)
      .map((figure) => ({ ...figure, ...study.report.labels?.figures?.[figure.id] }))
      .map((figure) => figureView(figure, numbers.next(), study.report.study, study.words));
    if (views.length > 0) sections.push({ id, title, content: views });
  }
  const { beliefs } = study.report;
  if (beliefs?.teams[0]) {
    const spheres = spheresSection({ beliefs, number: numbers.next(), study: study.report.study, words: study.words });
    sections.push({ id: 'beliefs', title: 'Belief spheres', content: [spheres] });
  }
  return sections;
}
